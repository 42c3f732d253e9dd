// Speed against accuracy on one session: each setting is fitted, and its model judged by the photographs kept out of the fit.
//
// Errors are those of image_error.h at the model's last stage, pooled over the held-out views. Their sigma is the standard
// error over held-out views (deviation of the views' own errors over the root of their number): how far the figure would
// move with other views held out. Two settings are judged on the same views, so their difference is surer than that; its
// sigma is the standard error of the views' differences.
//
// What a setting costs is CPU time, of all threads: wall time tells more of what else the machine did.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/evaluation/evaluate_model.h"
#include "processing/fit/tradeoff_settings.h"
#include "rig/progress.h"

namespace lumitexel {

class TradeoffJournal;

struct ErrorWithSpread {
  double value = std::numeric_limits<double>::quiet_NaN();
  double sigma = std::numeric_limits<double>::quiet_NaN();  // NaN with fewer than two views
};

struct TradeoffMeasurement {
  TradeoffSetting setting;
  std::string failure;  // why there is no measurement; empty if there is one
  std::size_t fit_views = 0, materials = 0;
  double cpu_seconds = 0;                  // of the fit, all threads: calibration and comparison are the same for all
  double seconds = 0;                      // wall time of the same
  std::optional<std::int64_t> peak_bytes;  // of the process during this fit; nothing where the system cannot tell
  ErrorWithSpread relative, clipped, square_root;
  std::vector<double> clipped_by_view;     // of the held-out views, in the session's order

  bool measured() const { return failure.empty(); }
};

// A setting against the standard preset.
struct TradeoffGain {
  ErrorWithSpread gain;    // clipped error of standard less that of this setting: above 0, this one is better
  double more_cpu_seconds = 0;  // of this setting than of standard
  // gain / more_cpu_seconds. Of a slower setting: what each second more buys; of a faster one: what each second saved costs.
  // Below 0, one of the two settings is both faster and better. NaN where the times do not differ by kSameTime.
  double per_second = std::numeric_limits<double>::quiet_NaN();
};

inline constexpr double kSameTime = 0.05;  // share of standard's time; runs of one setting differ by as much

struct Tradeoff {
  std::string session_key;
  std::size_t fit_views = 0, heldout_views = 0;
  std::vector<TradeoffMeasurement> measurements;  // in the order of the settings
};

// Throws BadInput, before anything is fitted, if the session holds no view out. A setting whose fit throws Error, or that asks
// for more views than there are, is a measurement with a failure; the others go on. With a journal, settings that it knows are not measured
// again, and the others are kept in it.
Tradeoff measure_tradeoff(const CalibratedSession& session, const std::vector<TradeoffSetting>& settings, TradeoffJournal* journal, Progress& progress);

// Whether each measurement is on the Pareto front: no other has no more CPU seconds and no more clipped error, and less of one.
std::vector<bool> pareto_front(const std::vector<TradeoffMeasurement>& measurements);

// Nothing for a failure, or without a measurement of the standard preset.
std::optional<TradeoffGain> gain_over_standard(const Tradeoff& tradeoff, const TradeoffMeasurement& measurement);

// Mean of values with its standard error.
ErrorWithSpread mean_with_spread(const std::vector<double>& values);

// The JSON of `lumitexel tradeoff --json`, as text; figures that do not exist are null.
std::string tradeoff_json(const Tradeoff& tradeoff);

}  // namespace lumitexel
