// How well poses are found from silhouettes: trials from random starts, at the rig's geometry.
//
// A line per case: trials, those that converged to the truth's basin, median and 95th percentile of the errors of turn and shift, the median
// silhouette distance, the ratio of scatter to stated sigma, and seconds per view.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <random>

#include "processing/calibration/pose/register_view.h"
#include "processing/surface/mesh_file.h"
#include "sim/loaded_object.h"
#include "sim/procedural_object.h"
#include "tests/bench/machine.h"
#include "tests/unit/pose/backlit_view.h"

namespace lumitexel {
namespace {

struct Case {
  std::string name;
  Mesh truth, scan;
};

struct Options {
  int trials = 20;
  std::uint64_t seed = 1;
  double megapixels = 12.0;
  std::string only;
  bool verbose = false;
  bool other_rotations = false;
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

Eigen::Vector3d random_vector(std::mt19937_64& random, double length) {
  std::normal_distribution<double> normal;
  Eigen::Vector3d v(normal(random), normal(random), normal(random));
  return length * v.normalized();
}

void run_case(const Case& c, const Options& options) {
  const RayScene rays(c.truth);
  const MeshSilhouette mesh(c.scan);
  const CameraModel camera = bench_camera(std::sqrt(options.megapixels / 12.582912));
  std::mt19937_64 random(options.seed);
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  std::vector<double> turns, shifts, distances, seconds, chi_turn, chi_shift, sigma_turn, sigma_shift;
  int converged = 0, ambiguous = 0;
  for (int trial = 0; trial < options.trials; ++trial) {
    const double angle = 2.0 * M_PI * uniform(random);
    Eigen::Isometry3d truth = bench_camera_from_table() * Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ());
    BacklitScene scene{c.truth, rays, camera, truth, {}, 10000.0, 4.0, 8};
    for (int k = 0; k < 6; ++k) {
      scene.discs.push_back({Eigen::Vector2d(camera.width_px * (0.1 + 0.16 * k), 0.06 * camera.height_px), 0.055 * camera.width_px});
    }
    const SilhouetteContour contour = silhouette_contour(backlit_view(scene, options.seed + 1000 + static_cast<std::uint64_t>(trial)));
    const Eigen::Isometry3d start = disturbed(truth, c.scan, random_vector(random, 20.0 * std::cbrt(uniform(random))),
                                              random_vector(random, 0.10 * std::cbrt(uniform(random))));
    const auto begin = std::chrono::steady_clock::now();
    const ContourLookup lookup(contour);
    ViewRegistrationOptions view_options;
    view_options.other_rotations = options.other_rotations;
    const ViewRegistration found = register_view(mesh, lookup, camera, start, view_options);
    const double taken_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const PoseError error = pose_error(found.camera_from_mesh, truth, c.scan);
    const bool in_basin = found.converged && error.turn_deg < 1.0 && error.shift_m < 0.01;
    converged += in_basin;
    ambiguous += found.ambiguous();
    seconds.push_back(taken_s);
    if (in_basin) {
      turns.push_back(error.turn_deg);
      shifts.push_back(1e3 * error.shift_m);
      distances.push_back(found.silhouette_px);
      chi_turn.push_back(error.turn_deg / found.sigma_deg);
      chi_shift.push_back(error.shift_m / found.sigma_m);
      sigma_turn.push_back(found.sigma_deg);
      sigma_shift.push_back(1e3 * found.sigma_m);
    }
    if (options.verbose || !in_basin) {
      std::printf("  trial %d: %s turn %.4f deg (sigma %.4f) shift %.4f mm (sigma %.4f; x %.3f y %.3f z %.3f) median %.3f px "
                  "explained %.3f n_ind %.0f model %d amb %zu %.2f s contour %zu\n", trial, in_basin ? "ok" : "MISSED", error.turn_deg, found.sigma_deg,
                  1e3 * error.shift_m, 1e3 * found.sigma_m, 1e3 * error.step[3], 1e3 * error.step[4], 1e3 * error.step[5],
                  found.silhouette_px, found.explained, found.independent, static_cast<int>(found.model), found.ambiguities.size(), taken_s, contour.points.size());
    }
  }
  const auto rms = [](const std::vector<double>& v) {
    double s = 0;
    for (double x : v) s += x * x;
    return v.empty() ? 0.0 : std::sqrt(s / static_cast<double>(v.size()));
  };
  std::printf("%-22s %5.1f MP %4d/%d found, %d ambiguous | turn deg median %.4f p95 %.4f sigma %.4f | shift mm median %.4f p95 %.4f sigma %.4f "
              "| silhouette px %.3f | error/sigma rms turn %.2f shift %.2f | %.2f s a view\n",
              c.name.c_str(), options.megapixels, converged, options.trials, ambiguous, quantile(turns, 0.5), quantile(turns, 0.95), quantile(sigma_turn, 0.5),
              quantile(shifts, 0.5), quantile(shifts, 0.95), quantile(sigma_shift, 0.5), quantile(distances, 0.5), rms(chi_turn), rms(chi_shift), quantile(seconds, 0.5));
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  CLI::App app("Accuracy of poses from silhouettes");
  Options options;
  app.add_option("--trials", options.trials, "per case");
  app.add_option("--seed", options.seed, "of starts, turns and noise");
  app.add_option("--megapixels", options.megapixels, "of the camera; the field of view stays");
  app.add_option("--case", options.only, "only cases whose name contains this");
  app.add_flag("--verbose", options.verbose, "a line per trial");
  app.add_flag("--other-rotations", options.other_rotations, "look for ambiguities among all rotations");
  CLI11_PARSE(app, argc, argv);
  std::cout << machine_line() << '\n';
  const VaseOptions vase_options{0.16, {0.0, 0.0, -0.008}, 1e-4, 1};
  VaseOptions plain = vase_options;
  plain.relief_rms_m = 1e-9;
  std::vector<Case> cases;
  const Mesh scan = vase_scan(vase_options);
  cases.push_back({"vase, exact", vase(plain), scan});
  cases.push_back({"vase, same mesh", cases[0].truth, cases[0].truth});
  cases.push_back({"vase, relief 0.1 mm", vase(vase_options), scan});
  const std::filesystem::path meshes = std::filesystem::path(LUMITEXEL_SOURCE_DIR).parent_path().parent_path() / "shared/data/meshes";
  for (const char* name : {"stanford-bunny", "spot"}) {
    const auto path = meshes / (std::string(name) + ".obj");
    if (!std::filesystem::exists(path)) { std::cout << path << " is not there\n"; continue; }
    const Mesh object = loaded_object(path, true, 0.16, {0, 0, 0});
    cases.push_back({std::string(name) + ", exact", object, object});
    cases.push_back({std::string(name) + ", smoothed", object, smoothed(object, 1e-4)});
  }
  for (const Case& c : cases) {
    if (c.name.find(options.only) != std::string::npos) run_case(c, options);
  }
  return 0;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) { return lumitexel::run(argc, argv); }
