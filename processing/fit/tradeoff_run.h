// One fit of a tradeoff: a setting and a draw of it, fitted and judged by held-out photographs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "processing/calibration/calibrated_session.h"
#include "processing/fit/error_spread.h"
#include "processing/fit/tradeoff_settings.h"
#include "rig/progress.h"

namespace lumitexel {

struct TradeoffRun {
  std::string failure;  // why there is no measurement; empty if there is one
  std::size_t fit_views = 0, materials = 0;
  double cpu_seconds = 0;                  // of the fit, all threads: calibration and comparison are the same for all
  double seconds = 0;                      // wall time of the same
  std::optional<std::int64_t> peak_bytes;  // of the process during this fit; nothing where the system cannot tell
  HeldoutError relative, clipped, square_root;  // of image_error.h, at the model's last stage

  bool measured() const { return failure.empty(); }
};

// How many stages fit_model and evaluate_model report for it.
int stages_of(const FitOptions& options);

// heldout: the session's held-out views, which judge. A fit that throws Error, or that asks for more views than there are, is a run with a
// failure; BadInput and Corrupt are the session's and go on to the caller.
TradeoffRun run_setting(const CalibratedSession& session, const CalibratedSession& heldout, const TradeoffSetting& setting, Progress& progress);

}  // namespace lumitexel
