// viewer_figures MODEL…: how like the ray tracer's the page's picture of a model is at every stage, and how long a picture takes in headless
// Chromium with its software renderer, at 800 x 600; with the page's size.
#include <cstdio>
#include <fstream>

#include "processing/model/model_file.h"
#include "processing/model/render_view.h"
#include "processing/report/viewer/viewer_page.h"
#include "tests/unit/temporary_folder.h"
#include "tests/viewer/viewer_likeness.h"

namespace lumitexel {
namespace {

constexpr int kWidth_px = 800, kHeight_px = 600, kFrames = 24;

View wide_view(const Model& model) {
  View view = framing_view(model.mesh, model.channels, kHeight_px, {0.35, -0.85, 0.4}, Eigen::Vector3d::UnitZ());
  view.camera.width_px = kWidth_px;
  view.camera.principal_x_px = 0.5 * kWidth_px;
  return view;
}

bool print_figures(const std::string& folder) {
  const Model model = read_model(folder);
  const ViewerPage page = viewer_page("figures", model);
  const TemporaryFolder out;
  std::ofstream(out / "page.html", std::ios::binary) << page.html;
  std::printf("%s: page %.1f MB, %zu texels, %zu triangles\n", folder.c_str(), 1e-6 * static_cast<double>(page.html.size()), page.textured_texels, model.mesh.triangles.size());
  std::vector<FitStage> stages;
  for (const FitStage stage : kFitStages) {
    if (holds_stage(model, stage)) stages.push_back(stage);
  }
  const View view = wide_view(model);
  const auto pictures = browser_pictures(out / "page.html", view, stages);
  if (!pictures) return false;
  const ModelSurface surface(model);
  for (const FitStage stage : stages) {
    const Likeness found = likeness(surface, view, stage, pictures->at(stage));
    std::printf("  %-10s %6.1f dB over %d of %d pixels, worst %.4f of white, %d pixels of outline differ\n", to_string(stage), found.psnr_db, found.same_texel,
                found.object_pixels, found.worst, found.other_outline);
    std::fflush(stdout);
  }
  for (const FitStage stage : {FitStage::Cluster, last_stage(model)}) {
    const auto frame_ms = browser_frame_ms(out / "page.html", view, stage, kFrames);
    if (!frame_ms) return false;
    std::printf("  %-10s %6.1f ms a picture, %.1f a second\n", to_string(stage), *frame_ms, 1000.0 / *frame_ms);
    std::fflush(stdout);
  }
  return true;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  if (argc < 2 || !lumitexel::has_chromium()) {
    std::fprintf(stderr, "usage: viewer_figures MODEL...   (needs chromium)\n");
    return 2;
  }
  for (int i = 1; i < argc; ++i) {
    if (!lumitexel::print_figures(argv[i])) {
      std::fprintf(stderr, "chromium did not come up with %s\n", argv[i]);
      return 1;
    }
  }
}
