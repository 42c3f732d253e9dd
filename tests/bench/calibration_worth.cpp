// What each step of the calibration buys: a session is calibrated with all steps, with each one left out, and with
// none; each time a model is fitted and held against the photographs that the fit did not see.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/evaluate_model.h"
#include "processing/model/fit_model.h"
#include "rig/session_store.h"
#include "tests/bench/machine.h"

namespace lumitexel {
namespace {

ImageError heldout_error(const SessionStore& store, const CalibrationOptions& steps, const FitOptions& fit) {
  NoProgress quiet;
  const CalibratedSession session = calibrate_session(store, quiet, nullptr, steps);
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
