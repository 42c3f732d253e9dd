// Speed against accuracy on one session: each setting is fitted, and its model judged by the photographs kept out of the fit.
//
// Errors are those of image_error.h at the model's last stage, pooled over the held-out views. Fits may be repeated with other draws of the
// points that materials are learnt on: error_spread.h has what views and draws say about an error's sigma. Two settings are judged on the
// same views and draws, so their difference is surer than either.
//
// What a setting costs is CPU time, of all threads: wall time tells more of what else the machine did.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/fit/error_spread.h"
#include "processing/fit/tradeoff_run.h"
#include "processing/fit/tradeoff_settings.h"
#include "rig/progress.h"

namespace lumitexel {

class TradeoffJournal;

struct TradeoffMeasurement {
  TradeoffSetting setting;
  std::vector<TradeoffRun> runs;  // a draw each, at least one; after one that failed there is none
  std::string failure;            // the first run's that failed: then nothing below is set
  double cpu_seconds = 0, seconds = 0;     // mean of the runs
  std::optional<std::int64_t> peak_bytes;  // the largest
  ErrorWithSpread relative, clipped, square_root;

  bool measured() const { return failure.empty(); }
};

// Of runs of a setting, in the order of draws.
TradeoffMeasurement summed_up(const TradeoffSetting& setting, const std::vector<TradeoffRun>& runs);

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
  int draws = 1;
  std::size_t known_before = 0;  // runs that the journal had
  std::vector<TradeoffMeasurement> measurements;  // in the order of the settings
};

// Each setting with draws 0 to draws - 1, at least one. Throws BadInput, before anything is fitted, if the session holds no view out. A setting whose fit
// fails (tradeoff_run.h) is a measurement with a failure; the others go on. With a journal, runs that it knows are not made again, and the
// others are kept in it.
Tradeoff measure_tradeoff(const CalibratedSession& session, const std::vector<TradeoffSetting>& settings, int draws, TradeoffJournal* journal,
                          Progress& progress);

// Whether each measurement is on the Pareto front: no other has no more CPU seconds and no more clipped error, and less of one.
std::vector<bool> pareto_front(const std::vector<TradeoffMeasurement>& measurements);

// Nothing for a failure, or without a measurement of the standard preset.
std::optional<TradeoffGain> gain_over_standard(const Tradeoff& tradeoff, const TradeoffMeasurement& measurement);

// Least and most of its draws.
std::pair<std::size_t, std::size_t> materials_found(const TradeoffMeasurement& measurement);
std::string materials_text(const TradeoffMeasurement& measurement);  // "17", or "17-20" where draws differ

// The JSON of `lumitexel tradeoff --json`, as text; figures that do not exist are null.
std::string tradeoff_json(const Tradeoff& tradeoff);

}  // namespace lumitexel
