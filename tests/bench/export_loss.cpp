// What the export's material costs in the picture: by form, with and without the texels' normals, for lamps beside the camera and raking ones.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "processing/export/conversion_loss.h"
#include "processing/model/model_file.h"
#include "tests/bench/machine.h"

namespace lumitexel {
namespace {

struct Errors {
  ImageError all, beside, raking;
};

// conversion_views come in pairs: the lamp beside the camera, then raking.
Errors errors_of(const Model& model, const ExportedMaps& maps, const std::vector<View>& views, const std::vector<RenderedView>& references) {
  ErrorSums sums[2];
  for (std::size_t v = 0; v < views.size(); ++v) {
    sums[v % 2].add(render_exported(model, maps, views[v]), references[v].radiance, references[v].hit);
  }
  ErrorSums all = sums[0];
  all.add(sums[1]);
  return {all.error(), sums[0].error(), sums[1].error()};
}

void print(const char* form, const char* normals, const Errors& errors) {
  std::printf("| %s | %s |", form, normals);
  for (const ImageError& e : {errors.all, errors.beside, errors.raking}) {
    std::printf(" %.1f dB, %.3f / %.3f / %.3f |", e.psnr_db, e.relative_rms, e.clipped_rms, e.sqrt_rms);
  }
  std::printf("\n");
}

void table(const Model& model) {
  const std::vector<View> views = conversion_views(model.mesh, model.channels);
  const ViewRenderer renderer(model);
  std::vector<RenderedView> references;
  for (const View& view : views) references.push_back(renderer.render(view, {}));
  std::printf("PSNR, relative / clipped / square-root RMS against the model's own rendering, %zu views\n", views.size());
  std::printf("| form | normals | all | lamp beside the camera | lamp raking |\n| --- | --- | --- | --- | --- |\n");
  for (const auto& [form, name] : {std::pair(MaterialForm::Gltf, "glTF"), std::pair(MaterialForm::Mitsuba, "Mitsuba")}) {
    NoProgress silent;
    ExportedMaps maps = refit_maps(model, silent, form);
    print(name, maps.normal.channels > 0 ? "the texels'" : "the mesh's: the texels have none", errors_of(model, maps, views, references));
    if (maps.normal.channels == 0) continue;
    maps.normal = {};
    print(name, "the mesh's", errors_of(model, maps, views, references));
  }
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  CLI::App app("Loss of exports by form and normals");
  std::string model;
  app.add_option("MODEL", model, "Folder of the model")->required();
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", lumitexel::machine_line().c_str());
  lumitexel::table(lumitexel::read_model(model));
}
