// What rendering a model costs and how good it is: points against rays, and how much less noise drawing an environment
// by importance leaves than drawing it evenly.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>

#include "drivers/clock.h"
#include "processing/evaluation/image_error.h"
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

// A dim sky over a dark ground with a sun of 4 degrees radius, 600 times as bright: hard to draw evenly.
Environment sun_and_sky(int channels) {
  constexpr int kWidth = 512, kHeight = 256;
  constexpr double kPi = std::numbers::pi, kSunRadius = 4.0 * kPi / 180.0;
  const Eigen::Vector3d sun = Eigen::Vector3d(0.55, -0.45, 0.7).normalized();
  Image image(kWidth, kHeight, channels);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < kWidth; ++x) {
      const double polar = kPi * (y + 0.5) / kHeight, azimuth = kPi * (1.0 - 2.0 * (x + 0.5) / kWidth);
      const Eigen::Vector3d d(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                              std::cos(polar));
      const double radiance = d.dot(sun) > std::cos(kSunRadius) ? 300.0 : d.z() > 0.0 ? 0.5 : 0.15;
      for (int c = 0; c < channels; ++c) image.at(x, y, c) = static_cast<float>(radiance);
    }
  }
  return Environment(std::move(image), Eigen::Matrix3d::Identity(), "sun and sky");
}

// Root mean square over the object's pixels of the difference to a far better picture, over its mean: what `noise`
// claims to be.
double true_noise(const LitView& lit, const LitView& reference) {
  double squares = 0.0, radiance = 0.0, values = 0.0;
  const auto channels = static_cast<std::size_t>(lit.radiance.channels);
  for (std::size_t i = 0; i < lit.radiance.data.size(); ++i) {
    if (reference.hit[i / channels] == 0) continue;
    squares += std::pow(static_cast<double>(lit.radiance.data[i]) - reference.radiance.data[i], 2);
    radiance += reference.radiance.data[i];
    values += 1.0;
  }
  return std::sqrt(squares / values) / (radiance / values);
}

void check_noise(const Model& model, const Environment& sky, int size_px) {
  const View view = framing_view(model.mesh, model.channels, size_px, {1.0, -1.0, 0.6}, Eigen::Vector3d::UnitZ());
  LitOptions options;
  options.path.bounces = 2;
  const auto with = [&](int samples) {
    options.limits.samples_per_pixel = samples;
    return render_environment(model, view, sky, options);
  };
  const LitView reference = with(2048);
  for (const int samples : {16, 64, 256}) {
    const LitView lit = with(samples);
    std::printf("%4d samples a pixel, 2 bounces, %.2f s: noise stated %.4f, true %.4f\n", samples, lit.seconds,
                *lit.noise, true_noise(lit, reference));
  }
}

int run(int argc, char** argv) {
  CLI::App app("Points against rays, and ways of drawing an environment, on one model");
  std::string model_path, sky_path;
  int size_px = 400;
  app.add_option("MODEL", model_path, "Folder of the model")->required();
  app.add_option("--environment", sky_path, "EXR to draw from instead of a sun in a dim sky");
  app.add_option("--size", size_px, "Side of the picture lit by the environment, pixels")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", machine_line().c_str());
  const Model model = read_model(model_path);
  for (const int size : {150, 300, 600, 1200}) compare_points(model, size);
  const Environment sky = sky_path.empty()
                              ? sun_and_sky(model.channels)
                              : read_environment(sky_path, 1.0, Eigen::Matrix3d::Identity(), model.channels);
  compare_drawing(model, sky, size_px);
  check_noise(model, sky, size_px / 2);
  return 0;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) { return lumitexel::run(argc, argv); }
