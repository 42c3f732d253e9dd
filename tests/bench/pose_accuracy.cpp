// How well one view's pose is found from its silhouette: trials from random starts, at the rig's geometry.
//
// A row per case: trials, those found (the truth's basin, and nothing said against it), those reported ambiguous, errors of turn and
// shift, the median silhouette distance, the ratio of scatter to stated sigma, and seconds per view. What the last campaign
// (cmake target run_pose_campaign) gave is in pose_accuracy.md beside this.
#include <malloc.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <iostream>
#include <random>

#include "processing/calibration/pose/register_view.h"
#include "sim/cube_sphere.h"
#include "sim/loaded_object.h"
#include "sim/procedural_object.h"
#include "tests/bench/machine.h"
#include "tests/unit/pose/backlit_view.h"

namespace lumitexel {
namespace {

struct Case {
  std::string name;
  Mesh truth, scan;
  bool symmetric = false;  // to be reported, not solved
};

struct Options {
  int trials = 20;
  int first_trial = 0;
  std::uint64_t seed = 1;
  double megapixels = 12.0;
  std::string only;
  bool verbose = false;
  bool other_rotations = false;
};

struct Trial {
  ViewRegistration found;
  PoseError error;
  double seconds = 0;
  bool in_basin() const { return found.converged && error.turn_deg < 1.0 && error.shift_m < 0.01; }
};

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1) + 0.5)];
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double x : values) sum += x * x;
  return values.empty() ? 0.0 : std::sqrt(sum / static_cast<double>(values.size()));
}

// Evenly in a ball.
Eigen::Vector3d random_vector(std::mt19937_64& random, double most) {
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const Eigen::Vector3d v(normal(random), normal(random), normal(random));
  return most * std::cbrt(uniform(random)) * v.normalized();
}

class PoseTrials {
 public:
  PoseTrials(const Case& c, const Options& options)
      : case_(c), options_(options), rays_(c.truth), mesh_(c.scan),
        camera_(bench_camera(std::sqrt(options.megapixels / 12.582912))) {}

  // Hangs on seed and number alone, so that a campaign can be run in parts.
  Trial run(int number) const {
    std::mt19937_64 random(options_.seed * 1'000'003 + static_cast<std::uint64_t>(number));
    std::uniform_real_distribution<double> angle(0.0, 2.0 * M_PI);
    const Eigen::Isometry3d truth = bench_camera_from_table() * Eigen::AngleAxisd(angle(random), Eigen::Vector3d::UnitZ());
    const SilhouetteContour contour = silhouette_contour(backlit_view(scene_at(truth), random()));
    const Eigen::Vector3d turn_deg = random_vector(random, 20.0), shift_m = random_vector(random, 0.10);
    const Eigen::Isometry3d start = disturbed(truth, case_.scan, turn_deg, shift_m);
    ViewRegistrationOptions view_options;
    view_options.other_rotations = options_.other_rotations || case_.symmetric;
    const auto begin = std::chrono::steady_clock::now();
    Trial trial;
    trial.found = register_view(mesh_, ContourLookup(contour), camera_, start, view_options);
    trial.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    trial.error = pose_error(trial.found.camera_from_mesh, truth, case_.scan);
    return trial;
  }

 private:
  BacklitScene scene_at(const Eigen::Isometry3d& truth) const {
    BacklitScene scene{case_.truth, rays_, camera_, truth, {}, 10000.0, 4.0, 8};
    for (int k = 0; k < 6; ++k) {  // the row of spheres
      const Eigen::Vector2d centre(camera_.width_px * (0.1 + 0.16 * k), 0.06 * camera_.height_px);
      scene.discs.push_back({centre, 0.055 * camera_.width_px});
    }
    return scene;
  }

  const Case& case_;
  const Options& options_;
  RayScene rays_;
  MeshSilhouette mesh_;
  CameraModel camera_;
};

void print_trial(int number, const Trial& t) {
  const ViewRegistration& f = t.found;
  std::printf("  trial %d: %s turn %.4f deg (sigma %.4f) shift %.4f mm (sigma %.4f; x %.3f y %.3f z %.3f) median %.3f px "
              "explained %.3f n_ind %.0f model %d amb %zu %.2f s %s\n",
              number, t.in_basin() ? "ok" : "MISSED", t.error.turn_deg, f.sigma_deg, 1e3 * t.error.shift_m, 1e3 * f.sigma_m,
              1e3 * t.error.step[3], 1e3 * t.error.step[4], 1e3 * t.error.step[5], f.silhouette_px, f.explained,
              f.independent, static_cast<int>(f.model), f.ambiguities.size(), t.seconds, f.problem.c_str());
}

void print_table_head() {
  std::printf("| case | found | ambiguous | turn deg: median, 95 %%, max | shift mm: median, 95 %%, max | silhouette px: median, max "
              "| error/sigma rms: turn, shift | s a view |\n| --- | --- | --- | --- | --- | --- | --- | --- |\n");
}

void run_case(const Case& c, const Options& options) {
  const PoseTrials trials(c, options);
  std::vector<double> turns, shifts, distances, seconds, chi_turn, chi_shift;
  int found = 0, ambiguous = 0;
  for (int k = 0; k < options.trials; ++k) {
    const Trial trial = trials.run(options.first_trial + k);
    const ViewRegistration& f = trial.found;
    ambiguous += f.ambiguous();
    seconds.push_back(trial.seconds);
    if (options.verbose || (!c.symmetric && !trial.in_basin())) print_trial(options.first_trial + k, trial);
    if (!trial.in_basin()) continue;
    ++found;
    turns.push_back(trial.error.turn_deg);
    shifts.push_back(1e3 * trial.error.shift_m);
    distances.push_back(f.silhouette_px);
    chi_turn.push_back(trial.error.turn_deg / f.sigma_deg);
    chi_shift.push_back(trial.error.shift_m / f.sigma_m);
  }
  std::printf("| %s | %d/%d | %d | %.4f, %.4f, %.4f | %.4f, %.4f, %.4f | %.3f, %.3f | %.2f, %.2f | %.2f |\n", c.name.c_str(), found,
              options.trials, ambiguous, quantile(turns, 0.5), quantile(turns, 0.95), quantile(turns, 1.0),
              quantile(shifts, 0.5), quantile(shifts, 0.95), quantile(shifts, 1.0), quantile(distances, 0.5),
              quantile(distances, 1.0), rms(chi_turn), rms(chi_shift), quantile(seconds, 0.5));
  std::fflush(stdout);
}

Mesh scaled(Mesh mesh, const Eigen::Vector3d& factors) {
  for (Eigen::Vector3d& x : mesh.positions) x = x.cwiseProduct(factors);
  return mesh;
}

std::vector<Case> all_cases() {
  std::vector<Case> cases;
  const VaseOptions vase_options{0.16, {0.0, 0.0, -0.008}, 1e-4, 1};
  VaseOptions plain = vase_options;
  plain.relief_rms_m = 1e-9;
  const Mesh scan = vase_scan(vase_options), smooth = vase(plain);
  cases.push_back({"vase, exact", smooth, smooth});
  cases.push_back({"vase by its scan of 28,000 triangles", smooth, scan});
  cases.push_back({"vase with 0.1 mm of relief by its scan", vase(vase_options), scan});
  const char* shared = std::getenv("LUMITEXEL_SHARED_DATA");
  const std::filesystem::path data = shared ? std::filesystem::path(shared)
                                            : std::filesystem::path(LUMITEXEL_SOURCE_DIR).parent_path() / "shared/data";
  for (const char* name : {"stanford-bunny", "spot"}) {
    const auto path = data / "meshes" / (std::string(name) + ".obj");
    if (!std::filesystem::exists(path)) {
      std::cout << path << " is not there\n";
      continue;
    }
    const Mesh object = loaded_object(path, true, 0.16, {0, 0, 0});
    cases.push_back({std::string(name) + ", exact", object, object});
    cases.push_back({std::string(name) + " by a mesh smoothed by 0.1 mm", object, smoothed(object, 1e-4)});
  }
  const Mesh spindle = scaled(cube_sphere(32), {0.04, 0.04, 0.08}), ball = scaled(cube_sphere(32), Eigen::Vector3d::Constant(0.06));
  cases.push_back({"spindle (a surface of revolution)", spindle, spindle, true});
  cases.push_back({"ball", ball, ball, true});
  return cases;
}

int run(int argc, char** argv) {
  CLI::App app("Accuracy of poses from silhouettes");
  Options options;
  app.add_option("--trials", options.trials, "per case");
  app.add_option("--first-trial", options.first_trial, "to run a campaign in parts");
  app.add_option("--seed", options.seed, "of starts, turns and noise");
  app.add_option("--megapixels", options.megapixels, "of the camera; the field of view stays");
  app.add_option("--case", options.only, "only cases whose name contains this");
  app.add_flag("--verbose", options.verbose, "a line per trial");
  app.add_flag("--other-rotations", options.other_rotations, "look for ambiguities among all rotations for every case");
  CLI11_PARSE(app, argc, argv);
  // Pictures of 50 MB are made and dropped all the time; asking the system for each would cost a quarter of the time.
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  std::cout << machine_line() << ", " << options.megapixels << " Mpixel, starts within 20 degrees and 10 cm" << std::endl;
  print_table_head();
  for (const Case& c : all_cases()) {
    if (c.name.find(options.only) != std::string::npos) run_case(c, options);
  }
  return 0;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) { return lumitexel::run(argc, argv); }
