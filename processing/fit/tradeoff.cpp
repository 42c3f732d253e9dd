#include "processing/fit/tradeoff.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "drivers/error.h"
#include "processing/fit/thinned_session.h"
#include "processing/fit/tradeoff_journal.h"

namespace lumitexel {
namespace {

constexpr std::int64_t kWhole_percent = 100;

// The stages that one setting reports become a part of one long stage, so that rate and time left are those of the whole.
class SettingProgress final : public Progress {
 public:
  SettingProgress(Progress& whole, std::size_t before, std::size_t runs, int stages)
      : whole_(whole), before_(static_cast<double>(before)), runs_(static_cast<double>(runs)), stages_(stages) {}
  void begin(const std::string&, std::int64_t total, const std::string&) override {
    ++stage_;
    total_ = std::max<std::int64_t>(1, total);
    update(0);
  }
  void update(std::int64_t done) override {
    const double share = (static_cast<double>(stage_ - 1) + static_cast<double>(done) / static_cast<double>(total_)) / stages_;
    whole_.update(static_cast<std::int64_t>(static_cast<double>(kWhole_percent) * (before_ + std::min(1.0, share)) / runs_));
  }

 private:
  Progress& whole_;
  double before_, runs_;
  std::int64_t total_ = 1, stage_ = 0;
  int stages_;
};

// Only held-out photographs: those of the fit would differ between settings with more and with fewer views.
CalibratedSession heldout_part(const CalibratedSession& session) {
  CalibratedSession part = session;
  std::erase_if(part.views, [](const View& view) { return !view.heldout; });
  return part;
}

TradeoffSetting with_draw(TradeoffSetting setting, int draw) {
  setting.options.draw = draw;
  return setting;
}

std::vector<HeldoutError> errors_of(const std::vector<TradeoffRun>& runs, HeldoutError TradeoffRun::*error) {
  std::vector<HeldoutError> errors;
  for (const TradeoffRun& run : runs) errors.push_back(run.*error);
  return errors;
}

// Draw after draw, of each all settings; what the journal has of them.
std::vector<std::optional<TradeoffRun>> known_runs(const std::vector<TradeoffSetting>& settings, int draws, const TradeoffJournal* journal) {
  std::vector<std::optional<TradeoffRun>> known;
  for (int draw = 0; draw < draws; ++draw) {
    for (const TradeoffSetting& setting : settings) {
      known.push_back(journal != nullptr ? journal->known(with_draw(setting, draw)) : std::nullopt);
    }
  }
  return known;
}

bool comparable(const TradeoffMeasurement& m) { return m.measured() && std::isfinite(m.clipped.value); }

bool dominates(const TradeoffMeasurement& a, const TradeoffMeasurement& b) {
  return a.cpu_seconds <= b.cpu_seconds && a.clipped.value <= b.clipped.value &&
         (a.cpu_seconds < b.cpu_seconds || a.clipped.value < b.clipped.value);
}

}  // namespace

TradeoffMeasurement summed_up(const TradeoffSetting& setting, const std::vector<TradeoffRun>& runs) {
  TradeoffMeasurement measurement;
  measurement.setting = setting;
  measurement.runs = runs;
  for (const TradeoffRun& run : runs) {
    if (run.measured()) continue;
    measurement.failure = run.failure;
    return measurement;
  }
  for (const TradeoffRun& run : runs) {
    measurement.cpu_seconds += run.cpu_seconds / static_cast<double>(runs.size());
    measurement.seconds += run.seconds / static_cast<double>(runs.size());
    if (run.peak_bytes) measurement.peak_bytes = std::max(measurement.peak_bytes.value_or(0), *run.peak_bytes);
  }
  measurement.relative = over_draws(errors_of(runs, &TradeoffRun::relative));
  measurement.clipped = over_draws(errors_of(runs, &TradeoffRun::clipped));
  measurement.square_root = over_draws(errors_of(runs, &TradeoffRun::square_root));
  return measurement;
}

Tradeoff measure_tradeoff(const CalibratedSession& session, const std::vector<TradeoffSetting>& settings, int draws, TradeoffJournal* journal,
                          Progress& progress) {
  Tradeoff tradeoff;
  tradeoff.session_key = session.key;
  tradeoff.fit_views = fit_views(session);
  tradeoff.heldout_views = heldout_views(session);
  tradeoff.draws = draws;
  if (tradeoff.heldout_views == 0) {
    throw BadInput("session", "no photograph is held out of the fit, so nothing can judge a model",
                   "some views with split = \"heldout\" in the capture plan, or heldout in column split of lights.csv before importing");
  }
  const CalibratedSession heldout = heldout_part(session);
  progress.begin("fits and comparisons", kWhole_percent, "%");
  const std::vector<std::optional<TradeoffRun>> known = known_runs(settings, draws, journal);
  const auto wanted = static_cast<std::size_t>(std::count_if(known.begin(), known.end(), [](const auto& run) { return !run.has_value(); }));
  tradeoff.known_before = known.size() - wanted;
  std::vector<std::vector<TradeoffRun>> runs(settings.size());
  std::size_t made = 0;
  // Draw after draw, so that whoever stops early and goes on with fewer draws has all settings.
  for (std::size_t i = 0; i < known.size(); ++i) {
    const std::size_t k = i % settings.size();
    if (known[i]) {
      runs[k].push_back(*known[i]);
      continue;
    }
    if (runs[k].empty() || runs[k].back().measured()) {  // else it would fail again
      const TradeoffSetting setting = with_draw(settings[k], static_cast<int>(i / settings.size()));
      progress.part(setting.name + (draws > 1 ? ", fit " + std::to_string(setting.options.draw + 1) + " of " + std::to_string(draws) : ""));
      SettingProgress part(progress, made, wanted, stages_of(setting.options));
      runs[k].push_back(run_setting(session, heldout, setting, part));
      if (journal != nullptr) journal->keep(setting, runs[k].back());
    }
    progress.update(kWhole_percent * static_cast<std::int64_t>(++made) / static_cast<std::int64_t>(wanted));
  }
  progress.update(kWhole_percent);
  for (std::size_t k = 0; k < settings.size(); ++k) tradeoff.measurements.push_back(summed_up(settings[k], runs[k]));
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
  std::vector<HeldoutError> gains;
  for (std::size_t k = 0; k < standard->runs.size(); ++k) gains.push_back(difference(standard->runs[k].clipped, measurement.runs.at(k).clipped));
  TradeoffGain gain;
  gain.gain = over_draws(gains);
  gain.more_cpu_seconds = measurement.cpu_seconds - standard->cpu_seconds;
  if (std::abs(gain.more_cpu_seconds) > kSameTime * standard->cpu_seconds) gain.per_second = gain.gain.value / gain.more_cpu_seconds;
  return gain;
}

std::pair<std::size_t, std::size_t> materials_found(const TradeoffMeasurement& measurement) {
  const auto [least, most] = std::minmax_element(measurement.runs.begin(), measurement.runs.end(),
                                                 [](const auto& a, const auto& b) { return a.materials < b.materials; });
  return {least->materials, most->materials};
}

std::string materials_text(const TradeoffMeasurement& measurement) {
  const auto [least, most] = materials_found(measurement);
  return std::to_string(least) + (most > least ? "-" + std::to_string(most) : "");
}

}  // namespace lumitexel
