// Light position by the spheres alone: error against truth and against the Cramer-Rao bound, over seeds; what the bound is
// for pictures of 0.8 and 12 Mpixel; what a wrong radius or spacing does; highlight fits under saturation and blur.
#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>

#include "processing/calibration/light/highlight_fit.h"
#include "tests/bench/machine.h"
#include "tests/unit/light/light_bound.h"

namespace lumitexel {
namespace {

struct Scatter {
  double error2 = 0, median_mm = 0, largest_mm = 0, mahalanobis2 = 0;  // over all lights and seeds
};

Scatter scatter_of(const SphereRig& believed, const SphereRig& truth, double sigma_px, int trials, std::uint64_t seed) {
  Scatter s;
  std::vector<double> errors;
  for (int t = 0; t < trials; ++t) {
    const RigHighlights seen = noisy_highlights(truth, sigma_px, seed + static_cast<std::uint64_t>(t));
    const LightSolution solution = solved_lights(believed, seen);
    for (std::size_t v = 0; v < truth.lights.size(); ++v) {
      const Eigen::Vector3d e = solution.lights[v].position - truth.lights[v];
      errors.push_back(1e3 * e.norm());
      s.error2 += e.squaredNorm();
      s.mahalanobis2 += e.dot(solution.lights[v].covariance.ldlt().solve(e));
    }
  }
  std::sort(errors.begin(), errors.end());
  s.error2 /= static_cast<double>(errors.size());
  s.mahalanobis2 /= static_cast<double>(errors.size());
  s.median_mm = errors[errors.size() / 2];
  s.largest_mm = errors.back();
  return s;
}

void against_the_bound(const char* what, const SphereRig& rig, double sigma_px, int trials, std::uint64_t seed) {
  double bound2 = 0.0;
  for (const Eigen::Matrix3d& b : position_bounds(rig, sigma_px)) bound2 += b.trace() / static_cast<double>(rig.lights.size());
  const Scatter s = scatter_of(rig, rig, sigma_px, trials, seed);
  std::printf("  %-42s %6.3f px %8.3f mm %8.3f mm %7.3f %8.3f %8.3f %7.2f\n", what, sigma_px, 1e3 * std::sqrt(bound2),
              1e3 * std::sqrt(s.error2), std::sqrt(s.error2 / bound2), s.median_mm, s.largest_mm, s.mahalanobis2);
}

void wrong_description(const char* what, double radius_factor, double spacing_factor) {
  const SphereRig truth = simulated_sphere_rig();
  SphereRig believed = truth;
  believed.line.radius_m *= radius_factor;
  believed.line.spacing_m *= spacing_factor;
  const LightSolution solution = solved_lights(believed, noisy_highlights(truth, 0.0, 1));
  std::printf("  %-30s", what);
  for (std::size_t v = 0; v < truth.lights.size(); ++v) {
    std::printf(" %7.3f", 1e3 * (solution.lights[v].position - truth.lights[v]).norm());
  }
  std::printf("   residual %.4f px\n", solution.residual_px);
}

// A highlight of GGX-like profile, blurred, noisy, cut at a part of its peak.
void clipped_highlights(double blur_px, double clip, int trials, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<float> noise(0.0f, 1.0f);
  std::uniform_real_distribution<double> within(0.0, 1.0);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double squares = 0.0, stated = 0.0;
  int fitted = 0;
  for (int t = 0; t < trials; ++t) {
    const Eigen::Vector2d truth(20.0 + within(random), 20.0 + within(random));
    MosaicRadiance m;
    m.width = m.height = 40;
    for (int i = 0; i < 1600; ++i) {
      double value = 0.0;
      constexpr int kSub = 4;
      for (int s = 0; s < kSub * kSub; ++s) {
        const Eigen::Vector2d p(i % 40 + (s % kSub + 0.5) / kSub, i / 40 + (s / kSub + 0.5) / kSub);
        const double r2 = (p - truth).squaredNorm() / (1.0 + blur_px * blur_px);
        value += 8000.0 / std::pow(1.0 + r2 / 2.5, 2.5) / (kSub * kSub);
      }
      const auto expected = static_cast<float>(value);
      const float noisy = expected + std::sqrt(9.0f + expected) * noise(random);
      const bool saturated = noisy > static_cast<float>(8000.0 * clip);
      m.value.push_back(saturated ? static_cast<float>(8000.0 * clip) : noisy);
      m.variance.push_back(9.0f + expected);
      m.flags.push_back(saturated ? kPixelSaturated : 0);
    }
    const auto fit = fit_highlight(m, truth + Eigen::Vector2d(0.4, -0.3), 8, std::nullopt);
    if (!fit) continue;
    ++fitted;
    sum += fit->pixel - truth;
    squares += (fit->pixel - truth).squaredNorm() / 2.0;
    stated += fit->sigma_px;
  }
  std::printf("  %5.1f px %6.2f %6d/%d %10.4f %10.4f %10.4f px\n", blur_px, clip, fitted, trials, sum.norm() / fitted,
              std::sqrt(squares / fitted), stated / fitted);
}

void run(int trials, std::uint64_t seed) {
  std::printf("%d trials, seed %llu; errors over four lights at about 1 m\n", trials, static_cast<unsigned long long>(seed));
  std::printf("  %-42s %9s %11s %11s %7s %8s %8s %7s\n", "six 2 cm spheres, 5 cm apart, at 1.05 m", "sigma", "bound", "rms error",
              "ratio", "median", "largest", "z2 (3)");
  for (const double sigma_px : {0.005, 0.01, 0.02, 0.05}) against_the_bound("1024 x 768", simulated_sphere_rig(), sigma_px, trials, seed);
  for (const double sigma_px : {0.01, 0.02}) against_the_bound("4096 x 3072", simulated_sphere_rig(4), sigma_px, trials, seed);
  const std::pair<const char*, Eigen::Vector3d> directions[] = {{"line parallel to the image's rows", {1, 0, 0}},
                                                                 {"line parallel to its columns", {0, 1, 0}},
                                                                 {"line at 45 degrees in depth", {1, 0, 1}},
                                                                 {"line at 80 degrees in depth", {0.15, 0.1, 1}}};
  for (const auto& [what, direction] : directions) {
    SphereRig rig = simulated_sphere_rig();
    rig.line.direction = direction.normalized();
    rig.line.first_centre = Eigen::Vector3d(0.0, -0.09, 1.05) - 2.5 * rig.line.spacing_m * rig.line.direction;
    against_the_bound(what, rig, 0.01, trials, seed);
  }
  std::printf("  exact highlights, error in mm of the four lights with\n");
  wrong_description("radius 0.1 % too large", 1.001, 1.0);
  wrong_description("spacing 0.1 % too large", 1.0, 1.001);
  wrong_description("both", 1.001, 1.001);
  std::printf("  blur, clipped at part of peak: fitted, bias, rms per axis, stated sigma\n");
  for (const double blur_px : {0.0, 1.0, 2.0}) {
    for (const double clip : {2.0, 0.7, 0.4, 0.2}) clipped_highlights(blur_px, clip, trials, seed);
  }
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  CLI::App app("Accuracy of light positions measured by spheres");
  int trials = 200;
  std::uint64_t seed = 1;
  app.add_option("--trials", trials)->check(CLI::Range(1, 100'000));
  app.add_option("--seed", seed);
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", lumitexel::machine_line().c_str());
  lumitexel::run(trials, seed);
}
