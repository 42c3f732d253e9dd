// What calibration does for an imported session: a session of exact poses is imported as it is, with its poses disturbed and with its
// focal length off; the poses before and after calibration are held against the exact ones, and models fitted with and without
// calibration against the photographs that the fit did not see.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <random>
#include <sstream>

#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"
#include "processing/calibration/import/colmap_text.h"
#include "processing/calibration/import/import_session.h"
#include "processing/calibration/pose/centred_pose.h"
#include "processing/evaluation/evaluate_model.h"
#include "processing/fit/fit_model.h"
#include "processing/surface/mesh_file.h"
#include "rig/session_store.h"
#include "rig/whole_file.h"
#include "tests/bench/machine.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

struct Disturbance {
  double shift_mm = 0, turn_deg = 0, focal = 1;  // rms of |shift|, |turn| of the object before the camera; focal length's factor
};

struct Options {
  fs::path oracle;
  FitOptions fit;
  bool with_fits = true;
};

CameraModel scaled_focal(CameraModel camera, double factor) {
  camera.focal_x_px *= factor;
  camera.focal_y_px *= factor;
  return camera;
}

std::string cameras_text(const std::map<std::int64_t, CameraModel>& cameras, double focal) {
  std::ostringstream text;
  text.precision(15);
  for (const auto& [id, camera] : cameras) {
    const CameraModel c = scaled_focal(camera, focal);
    text << id << " OPENCV " << c.width_px << ' ' << c.height_px << ' ' << c.focal_x_px << ' ' << c.focal_y_px << ' ' << c.principal_x_px
         << ' ' << c.principal_y_px << ' ' << c.k1 << ' ' << c.k2 << ' ' << c.p1 << ' ' << c.p2 << '\n';
  }
  return text.str();
}

std::string images_text(const std::vector<PosedImage>& images, const Eigen::Vector3d& centre, const Disturbance& by, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  std::ostringstream text;
  text.precision(15);
  for (std::size_t i = 0; i < images.size(); ++i) {
    PoseStep step;
    for (Eigen::Index k = 0; k < 6; ++k) {
      step[k] = normal(random) / std::sqrt(3.0) * (k < 3 ? by.turn_deg * std::numbers::pi / 180.0 : 1e-3 * by.shift_mm);
    }
    const Eigen::Isometry3d pose = CentredPose(images[i].camera_from_world, centre).moved(step).camera_from_mesh();
    const Eigen::Quaterniond q(pose.linear());
    const Eigen::Vector3d t = pose.translation();
    text << i + 1 << ' ' << q.w() << ' ' << q.x() << ' ' << q.y() << ' ' << q.z() << ' ' << t.x() << ' ' << t.y() << ' ' << t.z() << ' '
         << images[i].camera_id << ' ' << images[i].name << "\n\n";
  }
  return text.str();
}

struct PoseErrors {
  double turn_deg = 0, across_mm = 0, along_mm = 0;  // rms over the views, of the object's middle before the camera
};

PoseErrors errors_of(const CalibratedSession& session, const std::vector<PosedImage>& truth) {
  PoseErrors squares;
  const Eigen::Vector3d centre = extent_of(session.mesh).centre;
  const double n = static_cast<double>(truth.size());
  for (std::size_t v = 0; v < truth.size(); ++v) {
    const Eigen::Isometry3d &found = session.views[v].camera_from_world, &exact = truth[v].camera_from_world;
    const Eigen::Vector3d shift = 1e3 * (found * centre - exact * centre);
    squares.turn_deg += std::pow(Eigen::AngleAxisd(found.linear() * exact.linear().transpose()).angle() * 180.0 / std::numbers::pi, 2) / n;
    squares.across_mm += shift.head<2>().squaredNorm() / n;
    squares.along_mm += shift.z() * shift.z() / n;
  }
  return {std::sqrt(squares.turn_deg), std::sqrt(squares.across_mm), std::sqrt(squares.along_mm)};
}

std::optional<ImageError> heldout(const CalibratedSession& session, const Options& options) {
  if (!options.with_fits) return std::nullopt;
  NoProgress quiet;
  const FittedModel fitted = fit_model(session, options.fit, StageTimer(), quiet);
  const Evaluation evaluation = evaluate_model(fitted.model, session, quiet);
  return *evaluation.heldout[static_cast<std::size_t>(evaluation.last_stage)];
}

void print_row(const char* what, const PoseErrors& poses, const CalibratedSession& session, double focal_px,
               const std::optional<ImageError>& error) {
  std::printf("    %-10s %7.3f %7.3f %7.3f   %+7.3f", what, poses.turn_deg, poses.across_mm, poses.along_mm,
              100.0 * (session.views[0].camera.focal_x_px / focal_px - 1.0));
  if (error) std::printf("   %7.4f %7.4f %7.4f", error->relative_rms, error->clipped_rms, error->sqrt_rms);
  std::printf("\n");
  std::fflush(stdout);
}

struct Pair {
  std::optional<ImageError> given, calibrated;
};

Pair run_one(const Options& options, const Disturbance& by, std::uint64_t seed) {
  const auto cameras = parse_cameras_txt(read_whole_file(options.oracle / "cameras.txt"), "cameras.txt");
  const auto truth = parse_images_txt(read_whole_file(options.oracle / "images.txt"), "images.txt", cameras);
  const Eigen::Vector3d centre = extent_of(read_mesh(options.oracle / "mesh.ply")).centre;
  const TemporaryFolder folder;
  write_whole_file(folder / "cameras.txt", cameras_text(cameras, by.focal));
  write_whole_file(folder / "images.txt", images_text(truth, centre, by, seed));
  NoProgress quiet;
  import_session({folder.path(), options.oracle / "images", options.oracle / "lights.csv", options.oracle / "mesh.ply",
                  options.oracle / "masks", ""},
                 folder / "session", quiet);
  const SessionStore store = SessionStore::open(folder / "session", OpenMode::ReadOnly);
  const double focal_px = cameras.begin()->second.focal_x_px;
  std::printf("%.2f mm, %.2f degrees, focal length x %.4f, seed %d\n", by.shift_mm, by.turn_deg, by.focal, static_cast<int>(seed));
  const CalibratedSession given = calibrate_session(store, quiet, nullptr, {{CalibrationStep::Pose}});
  Pair errors;
  errors.given = heldout(given, options);
  print_row("given", errors_of(given, truth), given, focal_px, errors.given);
  CalibrationSummary summary;
  const CalibratedSession calibrated = calibrate_session(store, quiet, &summary);
  int replaced = 0;
  double sigma2_m = 0.0, sigma2_deg = 0.0;
  for (const PoseSummary& pose : summary.poses) {
    replaced += pose.source == "silhouette";
    sigma2_m += std::pow(pose.sigma_m.value_or(0.0), 2) / static_cast<double>(truth.size());
    sigma2_deg += std::pow(pose.sigma_deg.value_or(0.0), 2) / static_cast<double>(truth.size());
  }
  errors.calibrated = heldout(calibrated, options);
  print_row("calibrated", errors_of(calibrated, truth), calibrated, focal_px, errors.calibrated);
  std::printf("    %d of %zu poses replaced, lens: %s; stated sigma %.3f mm, %.3f degrees %s\n", replaced, truth.size(),
              summary.lens.source.c_str(), 1e3 * std::sqrt(sigma2_m), std::sqrt(sigma2_deg), summary.pose_problem.c_str());
  std::fflush(stdout);
  return errors;
}

// What calibration changed, seed by seed.
void print_gain(const std::vector<Pair>& pairs) {
  const auto n = static_cast<double>(pairs.size());
  if (pairs.size() < 2 || !pairs.front().given) return;
  std::printf("  calibrated less given, %zu seeds, mean and standard error:", pairs.size());
  for (const auto member : {&ImageError::relative_rms, &ImageError::clipped_rms, &ImageError::sqrt_rms}) {
    double mean = 0.0, squares = 0.0;
    for (const Pair& pair : pairs) mean += ((*pair.calibrated).*member - (*pair.given).*member) / n;
    for (const Pair& pair : pairs) squares += std::pow((*pair.calibrated).*member - (*pair.given).*member - mean, 2);
    std::printf("  %+.4f ± %.4f", mean, std::sqrt(squares / (n - 1.0) / n));
  }
  std::printf("\n");
}

int run(const Options& options, const std::vector<double>& shifts_mm, const std::vector<double>& turns_deg, double focal, int seeds) {
  std::printf("%s\n%s, %s quality, %d materials, normals %s\n", machine_line().c_str(), options.oracle.string().c_str(),
              options.fit.quality.c_str(), options.fit.materials, to_string(options.fit.normals));
  std::printf("poses, rms: turn (degrees), across and along the view (mm); focal length's error (%%)%s\n",
              options.with_fits ? "; held-out error: relative, clipped, square roots" : "");
  for (std::size_t k = 0; k < shifts_mm.size(); ++k) {
    std::vector<Pair> pairs;
    for (int seed = 1; seed <= seeds; ++seed) {
      pairs.push_back(run_one(options, {shifts_mm[k], turns_deg[k], 1.0}, static_cast<std::uint64_t>(seed)));
    }
    print_gain(pairs);
  }
  if (focal != 1.0) run_one(options, {0.0, 0.0, focal}, 1);
  return 0;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  CLI::App app("Poses and held-out error of an imported session, disturbed, before and after calibration");
  lumitexel::Options options;
  std::string oracle, quality = "standard";
  std::vector<double> shifts_mm{0.0, 0.2, 0.5, 1.0, 3.0}, turns_deg{0.0, 0.05, 0.1, 0.2, 0.5};
  int materials = 6, seeds = 1;
  double focal = 1.003;
  bool no_fits = false, plain = false;
  app.add_option("DIR", oracle, "Exact: cameras.txt, images.txt, lights.csv, mesh.ply, images/, masks/")->required();
  app.add_option("--shift-mm", shifts_mm, "Disturbances, one with each turn")->delimiter(',')->capture_default_str();
  app.add_option("--turn-deg", turns_deg, "Disturbances")->delimiter(',')->capture_default_str();
  app.add_option("--focal", focal, "Factor of the focal length in a run of its own; 1: none")->capture_default_str();
  app.add_option("--seeds", seeds, "Of each disturbance")->capture_default_str();
  app.add_option("--quality", quality, "Of the fits")->capture_default_str();
  app.add_option("--materials", materials, "To fit")->capture_default_str();
  app.add_flag("--poses-only", no_fits, "No fits, no held-out error");
  app.add_flag("--plain", plain, "Fits on the mesh's normals, without light between surfaces: a fifth of the time");
  CLI11_PARSE(app, argc, argv);
  if (shifts_mm.size() != turns_deg.size()) {
    std::fprintf(stderr, "--shift-mm and --turn-deg: as many of one as of the other\n");
    return 2;
  }
  options.oracle = oracle;
  options.fit = lumitexel::FitOptions::preset(quality);
  options.fit.materials = materials;
  if (plain) options.fit.normals = lumitexel::NormalChoice::Mesh;
  if (plain) options.fit.interreflections.choice = lumitexel::InterreflectionChoice::Off;
  options.with_fits = !no_fits;
  return lumitexel::run(options, shifts_mm, turns_deg, focal, seeds);
}
