// Light directions and normals from the photographs of a mirror ball and a gray ball (shared data uw-spheres): what the
// directions of the mirror ball, those that came with the data, and self-calibrated ones are worth.
//
// Self-calibration sees half of the gray ball's blocks of 16 x 16 pixels (a chequer); normals and predictions are judged on
// the other half.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "tests/bench/machine.h"
#include "tests/unit/light/photographed_balls.h"

namespace lumitexel {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

void print_normals(const char* what, const DirectionalLights& lights, const PhotographedBalls& balls, double sigma) {
  const NormalErrors e = normal_errors(lights, balls.judged, sigma);
  std::printf("  %-46s %6.2f %6.2f %6.2f %7.4f  %lld\n", what, e.mean_deg, e.median_deg, e.p95_deg,
              prediction_rms(lights, balls.heldout), static_cast<long long>(e.missing));
}

void print_terms(const ChosenLights& c) {
  const BallShading& s = c.lights.shading;
  std::printf("    held-out rms with response, roughness, gloss, ambient added in turn:");
  for (const double rms : c.tried_rms) std::printf(" %.4f", rms);
  std::printf("\n    chosen: gamma %.3f, roughness %.3f rad, gloss %.3f of width %.2f, ambient %.4f; converged %d\n", s.gamma,
              s.roughness, s.gloss, s.gloss_width, s.ambient, c.lights.converged);
}

void run(const std::string& folder, int step) {
  const PhotographedBalls balls = read_balls(folder, step);
  std::printf("mirror ball: radius %.1f px, outline %.2f px rms; gray ball: radius %.1f px, outline %.2f px rms\n",
              balls.mirror.radius_px, balls.mirror.outline_rms_px, balls.gray.radius_px, balls.gray.outline_rms_px);
  const DirectionalLights plain_given = plain_lights(balls.given), plain_mirror = plain_lights(balls.mirrored);
  const ChosenLights given = choose_terms(balls.fitted, balls.heldout, balls.given, true);
  const ChosenLights mirror = choose_terms(balls.fitted, balls.heldout, balls.mirrored, true);
  const ChosenLights own = choose_terms(balls.fitted, balls.heldout, balls.mirrored);
  DirectionalLights mirror_own_shading = own.lights;
  mirror_own_shading.directions = balls.mirrored;
  std::printf("gray ball, %zu pixels judged%33s deg: mean median    p95  held-out code rms, pixels without a normal\n", balls.judged.size(), "");
  print_normals("lights.txt, Lambert, linear", plain_given, balls, 0.01);
  print_normals("mirror ball, Lambert, linear", plain_mirror, balls, 0.01);
  print_normals("lights.txt, shading fitted", given.lights, balls, 0.01);
  print_terms(given);
  print_normals("mirror ball, shading fitted", mirror.lights, balls, 0.01);
  print_terms(mirror);
  print_normals("mirror ball, self-calibrated shading", mirror_own_shading, balls, 0.01);
  print_normals("self-calibrated directions and shading", own.lights, balls, 0.01);
  print_terms(own);
  std::printf("light  self-calibrated direction      sigma  strength  from mirror ball (its sigma)  from lights.txt, deg\n");
  for (std::size_t j = 0; j < balls.given.size(); ++j) {
    const Eigen::Vector3d& d = own.lights.directions[j];
    const auto off = [&](const Eigen::Vector3d& other) { return kDegrees * std::acos(std::min(1.0, d.dot(other))); };
    std::printf("%5zu  %8.4f %8.4f %8.4f  %6.2f  %8.3f  %12.2f (%.2f) %20.2f\n", j, d.x(), d.y(), d.z(),
                kDegrees * own.lights.sigma_rad[j], own.lights.strengths[j], off(balls.mirrored[j]),
                kDegrees * balls.mirrored_sigma_rad[j], off(balls.given[j]));
  }
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  CLI::App app("Photometric stereo on the photographed spheres");
  std::string folder = LUMITEXEL_SOURCE_DIR "/../shared/data/uw-spheres";
  int step = 4;
  app.add_option("--data", folder, "folder of uw-spheres")->check(CLI::ExistingDirectory);
  app.add_option("--step", step, "every so many pixels are fitted")->check(CLI::Range(1, 16));
  CLI11_PARSE(app, argc, argv);
  std::printf("%s\n", lumitexel::machine_line().c_str());
  lumitexel::run(folder, step);
}
