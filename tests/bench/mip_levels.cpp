// Coarser levels of a model's maps from afar: a session's held-out views at 1/2 to 1/16 scale, one ray a pixel, against the photographs
// averaged over as many pixels and against the model itself with that many rays a pixel.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "processing/evaluation/evaluate_model.h"
#include "processing/fit/mip_levels.h"
#include "processing/model/model_file.h"
#include "processing/model/render_view.h"
#include "rig/session_store.h"
#include "tests/bench/machine.h"

namespace lumitexel {
namespace {

View reduced(View view, int factor) {
  CameraModel& camera = view.camera;
  camera.width_px /= factor;
  camera.height_px /= factor;
  for (double* value : {&camera.focal_x_px, &camera.focal_y_px, &camera.principal_x_px, &camera.principal_y_px}) *value /= factor;
  return view;
}

// Means over factor x factor pixels; flags of any of them. Rows and columns that fill no whole pixel are left out.
RadianceImage reduced(const RadianceImage& photograph, int factor) {
  const Image& from = photograph.radiance;
  RadianceImage to{Image(from.width / factor, from.height / factor, from.channels), {}, {}};
  to.flags.assign(to.radiance.data.size() / static_cast<std::size_t>(from.channels), 0);
  for (int y = 0; y < to.radiance.height * factor; ++y) {
    for (int x = 0; x < to.radiance.width * factor; ++x) {
      to.flags[static_cast<std::size_t>(y / factor * to.radiance.width + x / factor)] |= photograph.flag(x, y);
      for (int c = 0; c < from.channels; ++c) {
        to.radiance.at(x / factor, y / factor, c) += from.at(x, y, c) / static_cast<float>(factor * factor);
      }
    }
  }
  return to;
}

struct Row {
  const char* name;
  const Model& model;
  bool supersampled;
  ErrorSums photographs{}, truth{};
};

void compare_level(const Model& model, const Model& averaged, const Model& refitted, const CalibratedSession& session, int factor) {
  Row rows[] = {{"own maps, one ray", model, false}, {"averaged", averaged, false}, {"refitted", refitted, false},
                {"own maps, many rays", model, true}};
  for (const View& full : session.views) {
    if (!full.heldout) continue;
    const View view = reduced(full, factor);
    const RadianceImage photograph = reduced(read_photograph(full, model.channels), factor);
    const RenderedView truth = ViewRenderer(model).render(view, {FitStage::Normal, factor * factor});
    std::vector<std::uint8_t> counted = object_pixels(photograph, truth.hit);
    for (std::size_t i = 0; i < counted.size(); ++i) counted[i] = counted[i] != 0 && truth.hit[i] != 0;
    for (Row& row : rows) {
      const Image image = row.supersampled ? truth.radiance : ViewRenderer(row.model).render(view, {}).radiance;
      row.photographs.add(image, photograph.radiance, counted);
      row.truth.add(image, truth.radiance, counted);
    }
  }
  for (const Row& row : rows) {
    const ImageError a = row.photographs.error(), b = row.truth.error();
    std::printf("1/%-3d %-22s %8.4f %8.4f %8.4f   %8.4f %8.4f %8.4f\n", factor, row.name, a.relative_rms, a.clipped_rms, a.sqrt_rms,
                b.relative_rms, b.clipped_rms, b.sqrt_rms);
  }
  std::fflush(stdout);
}

int run(const std::string& model_folder, const std::string& session_folder, int levels) {
  NoProgress silent;
  const Model model = read_model(model_folder);
  const CalibratedSession session = calibrate_session(SessionStore::open(session_folder, OpenMode::ReadOnly), silent);
  const LumitexelSet fine = texel_lumitexels(model, session, silent);
  std::printf("%-28s %-28s %s\n", "scale", "against held-out photographs", "against own maps, many rays");
  std::printf("%-28s %8s %8s %8s   %8s %8s %8s\n", "", "relative", "clipped", "sqrt", "relative", "clipped", "sqrt");
  for (int level = 1; level <= levels; ++level) {
    const Model averaged = averaged_level(model, level);
    compare_level(model, averaged, refitted_level(model, averaged, fine, session, level), session, 1 << level);
  }
  return 0;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  CLI::App app("Coarser levels of a model against its session's held-out photographs");
  std::string model, session;
  int levels = 4;
  app.add_option("MODEL", model)->required();
  app.add_option("SESSION", session)->required();
  app.add_option("--levels", levels)->check(CLI::Range(1, lumitexel::kMostLevels));
  CLI11_PARSE(app, argc, argv);
  std::puts(lumitexel::machine_line().c_str());
  return lumitexel::run(model, session, levels);
}
