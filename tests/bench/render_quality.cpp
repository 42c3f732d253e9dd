// What rendering a model costs and how good it is: points against rays, and how much less noise drawing an environment
// by importance leaves than drawing it evenly.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <optional>

#include "drivers/clock.h"
#include "processing/model/image_error.h"
#include "processing/model/model_file.h"
#include "processing/model/render_view.h"
#include "processing/render/render_lit.h"
#include "processing/render/splat.h"
#include "tests/bench/machine.h"

namespace lumitexel {
namespace {

template <typename Work>
double seconds_of(const Work& work) {
  const SystemClock clock;
  const double started_s = clock.now_s();
  work();
  return clock.now_s() - started_s;
}

// Pixels that the object fills with all their neighbours, as far as rays tell.
std::vector<std::uint8_t> filled_pixels(const RenderedView& rays) {
  const int width = rays.radiance.width, height = rays.radiance.height;
  std::vector<std::uint8_t> filled(rays.hit.size(), 0);
  for (int y = 1; y + 1 < height; ++y) {
    for (int x = 1; x + 1 < width; ++x) {
      bool all = true;
      for (int i = 0; i < 9; ++i)
        all = all && rays.hit[static_cast<std::size_t>((y + i / 3 - 1) * width + x + i % 3 - 1)] != 0;
      filled[static_cast<std::size_t>(y * width + x)] = all;
    }
  }
  return filled;
}

void compare_points(const Model& model, int size_px) {
  const View view = framing_view(model.mesh, model.channels, size_px, {1.0, -1.0, 0.6}, Eigen::Vector3d::UnitZ());
  RenderedView rays;
  SplatView points;
  const double ray_s = seconds_of([&] { rays = ViewRenderer(model).render(view, {FitStage::Pfa, 16}); });
  const double point_s = seconds_of([&] { points = splat(model, view, {view.light}, FitStage::Pfa); });
  std::vector<std::uint8_t> counted = filled_pixels(rays);
  double one = 0.0, either = 0.0, holes = 0.0;
  for (std::size_t p = 0; p < counted.size(); ++p) {
    one += (rays.hit[p] != 0) != (points.hit[p] != 0);
    either += rays.hit[p] != 0 || points.hit[p] != 0;
    holes += counted[p] != 0 && points.hit[p] == 0;
    counted[p] = counted[p] != 0 && points.hit[p] != 0;
  }
  ErrorSums sums;
  sums.add(points.radiance, rays.radiance, counted);
  std::printf(
      "%5d px: PSNR %5.1f dB where both see, %.2f %% of the centres seen by one alone, %.0f holes inside; %.2f s, 16 "
      "rays a pixel %.2f s\n",
      size_px, sums.error().psnr_db, 100.0 * one / either, holes, point_s, ray_s);
}

void compare_drawing(const Model& model, const Environment& sky, int size_px) {
  const View view = framing_view(model.mesh, model.channels, size_px, {1.0, -1.0, 0.6}, Eigen::Vector3d::UnitZ());
  const std::pair<const char*, EnvironmentSampling> ways[] = {{"uniform", EnvironmentSampling::Uniform},
                                                              {"BRDF", EnvironmentSampling::Brdf},
                                                              {"environment", EnvironmentSampling::Environment},
                                                              {"combined", EnvironmentSampling::Combined}};
  std::optional<double> plain;
  for (const auto& [name, way] : ways) {
    LitOptions options;
    options.path.sampling = way;
    const LitView lit = render_environment(model, view, sky, options);
    const double cost = *lit.noise * *lit.noise * lit.seconds;
    if (!plain) plain = cost;
    std::printf("%12s: noise %.4f after %d samples a pixel in %.2f s: %.1f times as efficient as uniform\n", name,
                *lit.noise, lit.samples_per_pixel, lit.seconds, *plain / cost);
  }
}

int run(int argc, char** argv) {
  CLI::App app("Points against rays, and ways of drawing an environment, on one model");
  std::string model_path, sky_path;
  int size_px = 400;
  app.add_option("MODEL", model_path, "Folder of the model")->required();
  app.add_option("--environment", sky_path, "EXR: also compare how it is drawn");
  app.add_option("--size", size_px, "Side of the picture lit by the environment, pixels")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", machine_line().c_str());
  const Model model = read_model(model_path);
  for (const int size : {150, 300, 600, 1200}) compare_points(model, size);
  if (!sky_path.empty()) {
    compare_drawing(model, read_environment(sky_path, 1.0, Eigen::Matrix3d::Identity(), model.channels), size_px);
  }
  return 0;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) { return lumitexel::run(argc, argv); }
