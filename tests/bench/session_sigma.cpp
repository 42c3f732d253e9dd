// Whether the sigmas of a whole calibration hold: a simulated session is captured and calibrated again and again, each time with other
// noise, and the errors against the simulation's truth are held against what the calibration states.
//
// For each quantity: the rms error over the stated sigma (1: honest; it holds both what scatters and what stays), and the
// scatter about the trials' own mean over the same. Everything runs in this process; sessions go to a temporary folder.
#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdio>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "drivers/error.h"
#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"
#include "processing/calibration/pose/centred_pose.h"
#include "rig/whole_file.h"
#include "tests/bench/machine.h"
#include "tests/unit/worth/simulated_capture.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

using nlohmann::json;

struct Options {
  std::string rig, plan;
  int trials = 20, first_seed = 100;
  double scale = 0.5;
  std::vector<std::string> without;
};

// One quantity's errors; a vector's components count as so many numbers of one sigma.
struct Ledger {
  std::vector<Eigen::VectorXd> errors;  // a trial
  std::vector<double> sigma;            // of a component

  void add(const Eigen::VectorXd& error, double stated) {
    errors.push_back(error);
    sigma.push_back(stated);
  }
};

void print_row(const std::string& name, const std::vector<Ledger>& entries, double factor, const char* unit) {
  double error2 = 0.0, scatter2 = 0.0, rms2 = 0.0, sigma_sum = 0.0, numbers = 0.0, freedom = 0.0, trials = 0.0;
  for (const Ledger& one : entries) {
    const std::size_t n = one.errors.size();
    if (n == 0) continue;
    Eigen::VectorXd mean = Eigen::VectorXd::Zero(one.errors[0].size());
    for (const Eigen::VectorXd& error : one.errors) mean += error / static_cast<double>(n);
    for (std::size_t t = 0; t < n; ++t) {
      error2 += one.errors[t].squaredNorm() / (one.sigma[t] * one.sigma[t]);
      scatter2 += (one.errors[t] - mean).squaredNorm() / (one.sigma[t] * one.sigma[t]);
      rms2 += one.errors[t].squaredNorm();
      sigma_sum += one.sigma[t];
      trials += 1.0;
    }
    numbers += static_cast<double>(n) * static_cast<double>(mean.size());
    freedom += (static_cast<double>(n) - 1.0) * static_cast<double>(mean.size());
  }
  if (numbers == 0.0) return;
  std::printf("| %s | %.4g %s | %.4g %s | %.2f | %.2f |\n", name.c_str(), factor * std::sqrt(rms2 / numbers), unit,
              factor * sigma_sum / trials, unit, std::sqrt(error2 / numbers), freedom > 0.0 ? std::sqrt(scatter2 / freedom) : 0.0);
}

struct Ledgers {
  std::map<std::string, Ledger> shift, turn, light, camera;
  Ledger scale;
};

Eigen::Isometry3d pose_from(const json& rows) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (Eigen::Index r = 0; r < 3; ++r) {
    for (Eigen::Index c = 0; c < 4; ++c) pose.matrix()(r, c) = rows.at(static_cast<std::size_t>(r)).at(static_cast<std::size_t>(c));
  }
  return pose;
}

void note_poses(const json& truth, const CalibratedSession& session, const CalibrationSummary& summary, Ledgers& all) {
  const Eigen::Vector3d middle = extent_of(session.mesh).centre;
  for (std::size_t v = 0; v < session.views.size(); ++v) {
    const PoseSummary& stated = summary.poses[v];
    if (!stated.sigma_m) continue;
    for (const json& entry : truth.at("poses")) {
      if (entry.at("view") != session.views[v].name) continue;
      const Eigen::Isometry3d true_pose = pose_from(entry.at("camera_from_world"));
      const Eigen::Isometry3d& found = session.views[v].camera_from_world;
      const Eigen::AngleAxisd turn(found.linear() * true_pose.linear().transpose());
      all.shift[stated.view].add(found * middle - true_pose * middle, *stated.sigma_m / std::sqrt(3.0));
      all.turn[stated.view].add(turn.angle() * turn.axis() * 180.0 / std::numbers::pi, *stated.sigma_deg / std::sqrt(3.0));
    }
  }
}

void note_lights(const json& truth, const CalibrationSummary& summary, Ledgers& all) {
  for (const LightSummary& light : summary.lights) {
    if (!(light.sigma_m > 0.0)) continue;
    for (const json& entry : truth.at("lights")) {
      if (entry.at("view") != light.view) continue;
      const auto p = entry.at("position_m").get<std::array<double, 3>>();
      all.light[light.view].add(light.position_in_world - Eigen::Vector3d(p[0], p[1], p[2]), light.sigma_m);
    }
  }
}

void note_camera(const json& truth, const LensSummary& lens, Ledgers& all) {
  if (lens.sigma.empty()) return;
  const auto p = truth.at("camera").at("params").get<std::array<double, 8>>();
  const std::array<const char*, 4> names{"focal length x", "focal length y", "principal point x", "principal point y"};
  for (std::size_t i = 0; i < names.size(); ++i) {
    all.camera[names[i]].add(Eigen::VectorXd::Constant(1, lens.params[i] - p[i]), lens.sigma[i]);
  }
}

// What the lamp sends towards the arm's pivot, of what it sends along its own axis: calibration states the former, the truth
// the latter.
double towards_pivot(const json& lamp) {
  constexpr double kDegree = std::numbers::pi / 180.0;
  const auto tilt = lamp.at("pattern_tilt_deg").get<std::array<double, 2>>();
  return std::pow(std::cos(kDegree * tilt[0]) * std::cos(kDegree * tilt[1]), lamp.at("pattern_exponent").get<double>());
}

// Mean of the channels' relative errors: they share the card's pose and the light's place, which dominate.
void note_scale(const json& truth, const CalibratedSession& session, const CalibrationSummary& summary, Ledgers& all) {
  auto expected = truth.at("scale").at("value").get<std::vector<double>>();
  for (double& value : expected) value *= towards_pivot(truth.at("lamp"));
  double error = 0.0;
  for (std::size_t c = 0; c < expected.size(); ++c) {
    error += (summary.intensity[c] / expected[c] - 1.0) / static_cast<double>(expected.size());
  }
  all.scale.add(Eigen::VectorXd::Constant(1, error), session.gray_card_scale_sigma);
}

void run_trial(const Options& options, const CalibrationOptions& steps, int seed, Ledgers& all) {
  const TemporaryFolder folder;
  const SessionStore store = capture_simulated({options.rig, options.plan, options.scale}, seed, folder.path()).session;
  NoProgress quiet;
  CalibrationSummary summary;
  const CalibratedSession session = calibrate_session(store, quiet, &summary, steps);
  const json truth = json::parse(read_whole_file(folder / "session" / "truth" / "calibration.json"));
  if (!summary.pose_problem.empty()) std::printf("seed %d: %s\n", seed, summary.pose_problem.c_str());
  note_poses(truth, session, summary, all);
  note_lights(truth, summary, all);
  note_camera(truth, summary.lens, all);
  note_scale(truth, session, summary, all);
}

std::vector<Ledger> values_of(const std::map<std::string, Ledger>& ledgers) {
  std::vector<Ledger> values;
  for (const auto& [name, ledger] : ledgers) values.push_back(ledger);
  return values;
}

void print_table(const Ledgers& all, int trials) {
  std::printf("\n%d trials\n| quantity | error rms | sigma stated | error/sigma | scatter/sigma |\n| --- | --- | --- | --- | --- |\n", trials);
  print_row("object before the camera, per axis", values_of(all.shift), 1e3, "mm");
  print_row("object's turn, per axis", values_of(all.turn), 1.0, "deg");
  print_row("light, per axis", values_of(all.light), 1e3, "mm");
  for (const auto& [name, ledger] : all.camera) print_row(name, {ledger}, 1.0, "px");
  print_row("absolute scale", {all.scale}, 100.0, "%");
  std::fflush(stdout);
}

int run(int argc, char** argv) {
  CLI::App app("Scatter of whole calibrations over their stated sigmas");
  Options options;
  app.add_option("RIG", options.rig, "a simulated rig")->required();
  app.add_option("PLAN", options.plan, "a capture plan")->required();
  app.add_option("--trials", options.trials, "sessions");
  app.add_option("--seed", options.first_seed, "of the first; the others follow");
  app.add_option("--scale", options.scale, "of the picture's sides")->check(CLI::Range(0.2, 4.0));
  app.add_option("--without", options.without, "calibration steps to leave out");
  CLI11_PARSE(app, argc, argv);
  CalibrationOptions steps;
  for (const std::string& step : options.without) steps.without.insert(calibration_step_from_string(step));
  std::printf("%s\n%s, %s, scale %g\n", machine_line().c_str(), options.rig.c_str(), options.plan.c_str(), options.scale);
  Ledgers all;
  for (int t = 0; t < options.trials; ++t) {
    run_trial(options, steps, options.first_seed + t, all);
    if (t % 5 == 4 || t + 1 == options.trials) print_table(all, t + 1);
  }
  return 0;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  try {
    return lumitexel::run(argc, argv);
  } catch (const lumitexel::Error& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
