#include "processing/fit/tradeoff.h"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <utility>

#include "drivers/error.h"
#include "processing/fit/coarser_session.h"
#include "processing/fit/fit_model.h"
#include "processing/fit/thinned_session.h"
#include "processing/fit/tradeoff_journal.h"

namespace lumitexel {
namespace {

constexpr std::int64_t kWhole_percent = 100;

// The stages that one setting reports become a part of one long stage, so that rate and time left are those of the whole.
class SettingProgress final : public Progress {
 public:
  SettingProgress(Progress& whole, std::size_t before, std::size_t settings, int stages)
      : whole_(whole), before_(static_cast<double>(before)), settings_(static_cast<double>(settings)), stages_(stages) {}
  void begin(const std::string&, std::int64_t total, const std::string&) override {
    ++stage_;
    total_ = std::max<std::int64_t>(1, total);
    update(0);
  }
  void update(std::int64_t done) override {
    const double share = (static_cast<double>(stage_ - 1) + static_cast<double>(done) / static_cast<double>(total_)) / stages_;
    whole_.update(static_cast<std::int64_t>(static_cast<double>(kWhole_percent) * (before_ + std::min(1.0, share)) / settings_));
  }

 private:
  Progress& whole_;
  double before_, settings_;
  std::int64_t total_ = 1, stage_ = 0;
  int stages_;
};

// Geometry, samples, materials, weights, comparison; bases and weights again; light between surfaces; normals and their trial, materials
// and weights again.
int stages_of(const FitOptions& options) {
  int stages = options.principal_functions ? 7 : 5;
  if (options.interreflections.wanted) stages += options.interreflections.rounds;
  if (options.normals == NormalChoice::Auto) ++stages;
  if (options.normals != NormalChoice::Mesh) stages += 3;
  return stages;
}

double cpu_seconds() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

void take_costs(const std::vector<StageCost>& stages, bool own_memory, TradeoffMeasurement& measurement) {
  std::int64_t peak_bytes = 0;
  for (const StageCost& stage : stages) {
    measurement.seconds += stage.seconds;
    peak_bytes = std::max(peak_bytes, stage.peak_bytes);
  }
  if (own_memory) measurement.peak_bytes = peak_bytes;
}

void take_errors(const Evaluation& evaluation, TradeoffMeasurement& measurement) {
  std::vector<double> relative, square_root;
  for (const ViewEvaluation& view : evaluation.views) {
    if (!view.heldout) continue;
    relative.push_back(view.error.relative_rms);
    measurement.clipped_by_view.push_back(view.error.clipped_rms);
    square_root.push_back(view.error.sqrt_rms);
  }
  const ImageError& pooled = *evaluation.heldout[static_cast<std::size_t>(evaluation.last_stage)];
  measurement.relative = {pooled.relative_rms, mean_with_spread(relative).sigma};
  measurement.clipped = {pooled.clipped_rms, mean_with_spread(measurement.clipped_by_view).sigma};
  measurement.square_root = {pooled.sqrt_rms, mean_with_spread(square_root).sigma};
}

// Only held-out photographs: those of the fit would differ between settings with more and with fewer views.
CalibratedSession heldout_part(const CalibratedSession& session) {
  CalibratedSession part = session;
  std::erase_if(part.views, [](const View& view) { return !view.heldout; });
  return part;
}

TradeoffMeasurement measured(const CalibratedSession& session, const CalibratedSession& heldout, const TradeoffSetting& setting,
                             Progress& progress) {
  TradeoffMeasurement measurement;
  measurement.setting = setting;
  const std::size_t views = setting.fit_views == 0 ? fit_views(session) : setting.fit_views;
  if (views > fit_views(session)) {
    measurement.failure = "the session has " + std::to_string(fit_views(session)) + " photographs to fit";
    return measurement;
  }
  measurement.fit_views = views;
  try {
    const CoarserSession coarser(with_fit_views(session, views), setting.pixel_block);
    const bool own_memory = restart_peak_memory();
    const double cpu_before = cpu_seconds();
    const FittedModel fitted = fit_model(coarser.session(), setting.options, {}, progress);
    measurement.cpu_seconds = cpu_seconds() - cpu_before;
    measurement.materials = fitted.model.materials.size();
    take_costs(fitted.summary.stages, own_memory, measurement);
    take_errors(evaluate_model(fitted.model, heldout, progress), measurement);
  } catch (const BadInput&) {
    throw;
  } catch (const Corrupt&) {
    throw;  // the session's files, not this setting
  } catch (const Error& error) {
    measurement.failure = error.what();
  }
  return measurement;
}

bool comparable(const TradeoffMeasurement& m) { return m.measured() && std::isfinite(m.clipped.value); }

bool dominates(const TradeoffMeasurement& a, const TradeoffMeasurement& b) {
  return a.cpu_seconds <= b.cpu_seconds && a.clipped.value <= b.clipped.value &&
         (a.cpu_seconds < b.cpu_seconds || a.clipped.value < b.clipped.value);
}

}  // namespace

ErrorWithSpread mean_with_spread(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto count = static_cast<double>(values.size());
  double mean = 0.0, squares = 0.0;
  for (const double value : values) mean += value / count;
  for (const double value : values) squares += (value - mean) * (value - mean);
  ErrorWithSpread result;
  result.value = mean;
  if (values.size() > 1) result.sigma = std::sqrt(squares / (count - 1.0) / count);
  return result;
}

Tradeoff measure_tradeoff(const CalibratedSession& session, const std::vector<TradeoffSetting>& settings, TradeoffJournal* journal, Progress& progress) {
  Tradeoff tradeoff;
  tradeoff.session_key = session.key;
  tradeoff.fit_views = fit_views(session);
  tradeoff.heldout_views = heldout_views(session);
  if (tradeoff.heldout_views == 0) {
    throw BadInput("session", "no photograph is held out of the fit, so nothing can judge a model",
                   "some views with split = \"heldout\" in the capture plan, or heldout in column split of lights.csv before importing");
  }
  const CalibratedSession heldout = heldout_part(session);
  progress.begin("fits and comparisons", kWhole_percent, "%");
  for (const TradeoffSetting& setting : settings) {
    const std::size_t before = tradeoff.measurements.size();
    const std::optional<TradeoffMeasurement> known = journal != nullptr ? journal->known(setting) : std::nullopt;
    SettingProgress part(progress, before, settings.size(), stages_of(setting.options));
    tradeoff.measurements.push_back(known ? *known : measured(session, heldout, setting, part));
    if (journal != nullptr && !known) journal->keep(tradeoff.measurements.back());
    progress.update(kWhole_percent * static_cast<std::int64_t>(before + 1) / static_cast<std::int64_t>(settings.size()));
  }
  return tradeoff;
}

std::vector<bool> pareto_front(const std::vector<TradeoffMeasurement>& measurements) {
  std::vector<bool> front;
  for (const TradeoffMeasurement& one : measurements) {
    const bool beaten = std::any_of(measurements.begin(), measurements.end(), [&](const TradeoffMeasurement& other) {
      return comparable(other) && dominates(other, one);
    });
    front.push_back(comparable(one) && !beaten);
  }
  return front;
}

std::optional<TradeoffGain> gain_over_standard(const Tradeoff& tradeoff, const TradeoffMeasurement& measurement) {
  const auto standard = std::find_if(tradeoff.measurements.begin(), tradeoff.measurements.end(), [](const auto& m) {
    return m.setting.name == kStandardSetting;
  });
  if (standard == tradeoff.measurements.end() || !comparable(*standard) || !comparable(measurement)) return std::nullopt;
  std::vector<double> differences;
  for (std::size_t v = 0; v < standard->clipped_by_view.size(); ++v) {
    differences.push_back(standard->clipped_by_view[v] - measurement.clipped_by_view.at(v));
  }
  TradeoffGain gain;
  gain.gain = {standard->clipped.value - measurement.clipped.value, mean_with_spread(differences).sigma};
  gain.more_cpu_seconds = measurement.cpu_seconds - standard->cpu_seconds;
  if (std::abs(gain.more_cpu_seconds) > kSameTime * standard->cpu_seconds) gain.per_second = gain.gain.value / gain.more_cpu_seconds;
  return gain;
}

}  // namespace lumitexel
