// What each step of the calibration buys: a session is calibrated with all steps, with each one left out, and with
// none, and of a simulated session with its true lens, poses and light positions; each time a model is fitted and held
// against the photographs that the fit did not see.
#include <CLI/CLI.hpp>
#include <array>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "processing/calibration/calibrated_session.h"
#include "processing/evaluation/evaluate_model.h"
#include "processing/fit/fit_model.h"
#include "rig/session_store.h"
#include "tests/bench/machine.h"

namespace lumitexel {
namespace {

// Lens, poses and light positions of a simulated session replaced by what they are.
void take_truth(CalibratedSession& session, const nlohmann::json& truth) {
  const auto p = truth.at("camera").at("params").get<std::array<double, 8>>();
  for (View& view : session.views) {
    view.camera = {view.camera.width_px, view.camera.height_px, p[0], p[1], p[2], p[3], p[4], p[5], p[6], p[7]};
    for (const nlohmann::json& pose : truth.at("poses")) {
      if (pose.at("view") != view.name) continue;
      for (std::size_t i = 0; i < 12; ++i) {
        view.camera_from_world.matrix()(static_cast<Eigen::Index>(i / 4), static_cast<Eigen::Index>(i % 4)) =
            pose.at("camera_from_world").at(i / 4).at(i % 4).get<double>();
      }
    }
    for (const nlohmann::json& light : truth.at("lights")) {
      if (light.at("view") != view.name) continue;
      const auto x = light.at("position_m").get<std::array<double, 3>>();
      view.light.vector_in_world = {x[0], x[1], x[2]};
    }
  }
}

ImageError heldout_error(const SessionStore& store, const CalibrationOptions& steps, const FitOptions& fit,
                         const nlohmann::json& truth = nullptr) {
  NoProgress quiet;
  CalibratedSession session = calibrate_session(store, quiet, nullptr, steps);
  if (!truth.is_null()) take_truth(session, truth);
  const FittedModel fitted = fit_model(session, fit, StageTimer(), quiet);
  const Evaluation evaluation = evaluate_model(fitted.model, session, quiet);
  return *evaluation.heldout[static_cast<std::size_t>(evaluation.last_stage)];
}

void print_row(const std::string& name, const ImageError& error, const ImageError& all) {
  std::printf("%-24s %8.4f %8.4f %8.4f %7.2f   %+6.1f %%\n", name.c_str(), error.relative_rms, error.clipped_rms,
              error.sqrt_rms, error.psnr_db, 100.0 * (error.clipped_rms / all.clipped_rms - 1.0));
  std::fflush(stdout);
}

int run(const std::string& directory, const FitOptions& fit, const std::vector<CalibrationStep>& steps, bool with_none) {
  const SessionStore store = SessionStore::open(directory, OpenMode::ReadOnly);
  std::printf("%s\n%s, %s quality, %d materials; held-out photographs\n", machine_line().c_str(), directory.c_str(),
              fit.quality.c_str(), fit.materials);
  std::printf("%-24s %8s %8s %8s %7s   %s\n", "calibrated", "relative", "clipped", "sqrt", "PSNR", "clipped");
  const ImageError all = heldout_error(store, {}, fit);
  print_row("with everything", all, all);
  // What a perfect calibration would give: below this a row owes its figure to errors that happen to suit the fit.
  std::ifstream truth(std::filesystem::path(directory) / "truth" / "calibration.json");
  if (truth) print_row("by the truth", heldout_error(store, {}, fit, nlohmann::json::parse(truth)), all);
  for (const CalibrationStep step : steps) {
    print_row(std::string("without ") + to_string(step), heldout_error(store, {{step}}, fit), all);
  }
  if (!with_none) return 0;
  const auto& every = all_calibration_steps();
  print_row("without any of them", heldout_error(store, {{every.begin(), every.end()}}, fit), all);
  return 0;
}

}  // namespace
}  // namespace lumitexel

int main(int argc, char** argv) {
  CLI::App app("Held-out relighting error with and without each step of the calibration");
  std::string session, quality = "draft";
  int materials = 4;
  app.add_option("SESSION", session, "A captured session")->required();
  app.add_option("--quality", quality, "Of the fit: draft, standard or reference")->capture_default_str();
  app.add_option("--materials", materials, "Materials to fit")->capture_default_str();
  std::vector<std::string> only;
  app.add_option("--only", only, "These steps and no others are left out, one at a time")->delimiter(',');
  CLI11_PARSE(app, argc, argv);
  lumitexel::FitOptions fit = lumitexel::FitOptions::preset(quality);
  fit.materials = materials;
  std::vector<lumitexel::CalibrationStep> steps;
  for (const std::string& name : only) steps.push_back(lumitexel::calibration_step_from_string(name));
  const auto& every = lumitexel::all_calibration_steps();
  if (only.empty()) steps.assign(every.begin(), every.end());
  return lumitexel::run(session, fit, steps, only.empty());
}
