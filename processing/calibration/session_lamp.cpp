#include "processing/calibration/session_lamp.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>
#include <numeric>

#include "processing/calibration/light/lamp_drift.h"
#include "processing/calibration/light/white_patches.h"

namespace lumitexel {
namespace {

const Eigen::Vector3d kUpInRig = Eigen::Vector3d::UnitZ();  // of the arm's elevation (LightPositionerDescription)

// The lamp points at the pivot, which the arm's alignment has moved.
Eigen::Isometry3d lamp_frame(const CapturedInputs& in, const SessionLights& lights, const Eigen::Vector3d& light) {
  const Eigen::Vector3d offset = lights.arm.correction().head<3>();
  return lamp_from_rig(light, in.rig.light_positioner.pivot_in_rig + offset, kUpInRig);
}

// White patches are read in green.
double green_of(const std::vector<double>& channels) { return channels.size() == 3 ? channels[1] : channels[0]; }

// A reading freed of the lamp's pattern: the mean over the channels' logarithms, and each channel's distance from it.
struct FreedReading {
  double log_mean = 0;
  std::vector<double> log_ratio;
  double sigma = 0;  // of log_mean, without what all readings share
};

enum class Strays { LeftIn, TakenOut };

FreedReading freed(const TimedReading& timed, const Eigen::Isometry3d& lamp_from_rig, const LampPattern& pattern, Strays strays) {
  const CardReading& reading = *timed.reading;
  const double factor = pattern.factor(lamp_from_rig * reading.card_in_rig);
  FreedReading result;
  for (const double intensity : reading.intensity) result.log_ratio.push_back(std::log(intensity / factor));
  if (strays == Strays::TakenOut) {
    for (std::size_t c = 0; c < timed.stray_shares.size(); ++c) result.log_ratio[c] -= std::log1p(timed.stray_shares[c]);
  }
  result.log_mean = std::accumulate(result.log_ratio.begin(), result.log_ratio.end(), 0.0) /
                    static_cast<double>(result.log_ratio.size());
  for (double& ratio : result.log_ratio) ratio -= result.log_mean;
  result.sigma = std::hypot(reading.pixel_sigma, reading.light_sigma);
  return result;
}

// Ratios of the channels, which a lamp's drift leaves alone: the weighted mean over the readings that fit.
std::vector<double> channel_ratios(const std::vector<FreedReading>& readings, const std::vector<bool>& used) {
  std::vector<double> sums(readings[0].log_ratio.size(), 0.0);
  double weights = 0.0;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    if (!used[i]) continue;
    const double weight = 1.0 / (readings[i].sigma * readings[i].sigma);
    for (std::size_t c = 0; c < sums.size(); ++c) sums[c] += weight * readings[i].log_ratio[c];
    weights += weight;
  }
  for (double& sum : sums) sum = std::exp(sum / weights);
  return sums;
}

// The lamp by all readings that show the card.
struct LampHistory {
  LampDrift drift;
  std::vector<double> ratios;  // of the channels

  std::vector<double> intensity(double time_s) const {
    const double mean = drift.intensity(time_s).factor;
    std::vector<double> channels;
    for (const double ratio : ratios) channels.push_back(mean * ratio);
    return channels;
  }
};

LampHistory lamp_history(const CapturedInputs& in, const SessionLights& lights, const LampPattern& pattern,
                         const std::vector<TimedReading>& readings, Strays strays) {
  std::vector<CardSample> samples;
  std::vector<FreedReading> all;
  for (const TimedReading& timed : readings) {
    all.push_back(freed(timed, lamp_frame(in, lights, timed.light_in_rig), pattern, strays));
    samples.push_back({timed.time_s, std::exp(all.back().log_mean), all.back().sigma});
  }
  LampDrift drift(samples);
  std::vector<double> ratios = channel_ratios(all, drift.used());
  return {std::move(drift), std::move(ratios)};
}

// How much more the lamp seems to give for the strays: the most of any channel, relative to what it gives itself.
double stray_excess(const std::vector<double>& with, const std::vector<double>& without) {
  double most = 0.0;
  for (std::size_t c = 0; c < with.size(); ++c) most = std::max(most, std::abs(with[c] / without[c] - 1.0));
  return most;
}

void add_shares(CalibrationSummary& summary, const std::vector<std::pair<std::string, double>>& sigmas) {
  double total = 0.0;
  for (const auto& [source, sigma] : sigmas) total += sigma * sigma;
  for (const auto& [source, sigma] : sigmas) {
    if (total > 0.0) summary.shares.push_back({"scale", source, sigma * sigma / total});
  }
}

}  // namespace

LampPattern measure_lamp_pattern(const CapturedFrames& frames, const CapturedInputs& in, const RadianceReader& reader,
                                 const SessionLens& lens, const SessionLights& lights, const SessionStrays& strays,
                                 const CalibrationOptions& options, CalibrationSummary& summary) {
  constexpr int kPlacement = 1;  // in which the schedule takes these shots
  const auto board = lens.camera_from_board.find(kPlacement);
  if (!options.takes(CalibrationStep::LampPattern) || !frames.has(ShotKind::LampPattern) ||
      board == lens.camera_from_board.end()) {
    return {};
  }
  const std::vector<FrameRecord> bracket = frames.of(ShotKind::LampPattern);
  const ArmPrediction light = lights.arm.predict(bracket[0].light_azimuth_deg, bracket[0].light_elevation_deg);
  const Eigen::Isometry3d lamp_from_camera =
      lamp_frame(in, lights, light.position_in_rig) * in.rig.camera.camera_from_rig.inverse();
  const Eigen::Isometry3d rig_from_camera = in.rig.camera.camera_from_rig.inverse();
  std::vector<PatternSample> samples;
  std::vector<double> shares;
  for (const WhitePatch& patch : white_patches(reader.read(bracket), lens.camera, board->second, *in.rig.board)) {
    samples.push_back({0, lamp_from_camera * patch.position_in_camera,
                       lamp_from_camera.linear() * patch.normal_in_camera, patch.radiance, patch.variance});
    if (!strays.any()) continue;
    const LitPlace place{rig_from_camera * patch.position_in_camera, rig_from_camera.linear() * patch.normal_in_camera};
    shares.push_back(green_of(strays.shares(place, light.position_in_rig)));
  }
  const PatternFit fit = strays.any() ? fit_lamp_pattern(samples, shares) : fit_lamp_pattern(samples);
  summary.lamp.pattern_parameters = fit.parameters;
  if (fit.parameters == 0) return fit.pattern;
  const double angle = 10.0 * std::numbers::pi / 180.0;
  const Eigen::Vector3d aside(std::sin(angle), 0.0, std::cos(angle));
  summary.lamp.at_10_deg = fit.pattern.factor(aside);
  summary.lamp.at_10_deg_sigma = fit.pattern.sigma(aside);
  return fit.pattern;
}

SessionLamp measure_lamp(const CapturedInputs& in, const SessionLights& lights, const LampPattern& pattern,
                         const std::vector<TimedReading>& views, const TimedReading& card,
                         const CalibrationOptions& options, CalibrationSummary& summary) {
  std::vector<TimedReading> readings{card};
  if (options.takes(CalibrationStep::LampDrift)) {
    std::copy_if(views.begin(), views.end(), std::back_inserter(readings), [](const TimedReading& view) { return view.reading.has_value(); });
  }
  const LampHistory history = lamp_history(in, lights, pattern, readings, Strays::LeftIn);
  std::optional<LampHistory> alone;
  if (std::any_of(readings.begin(), readings.end(), [](const TimedReading& timed) { return !timed.stray_shares.empty(); })) {
    alone = lamp_history(in, lights, pattern, readings, Strays::TakenOut);
  }

  SessionLamp lamp;
  lamp.pattern = pattern;
  for (const TimedReading& view : views) {
    lamp.intensity.push_back(history.intensity(view.time_s));
    lamp.lamp_from_rig.push_back(lamp_frame(in, lights, view.light_in_rig).linear());
    const LampFactor factor = history.drift.relative(view.time_s, card.time_s);
    const double by_strays = alone ? factor.factor - alone->drift.relative(view.time_s, card.time_s).factor : 0.0;
    summary.lamp.factor.push_back(factor.factor);
    summary.lamp.factor_sigma.push_back(std::hypot(factor.sigma, by_strays));
  }
  const LampFactor at_card = history.drift.intensity(card.time_s);
  const double at_card_sigma = at_card.sigma / at_card.factor;
  summary.intensity = history.intensity(card.time_s);
  const double by_strays = alone ? stray_excess(summary.intensity, alone->intensity(card.time_s)) : 0.0;
  summary.gray_card_pixel_scatter = card.reading->pixel_scatter;
  summary.lamp.drifts = history.drift.drifts();
  summary.lamp.card_views = static_cast<int>(readings.size()) - 1;
  for (const bool used : history.drift.used()) summary.lamp.card_outliers += !used;
  // Lights are all wrong by as much where the sphere line is.
  const double common_light =
      2.0 * lights.shared_sigma_m / (card.light_in_rig - card.reading->card_in_rig).norm();
  lamp.scale_sigma = std::hypot(std::hypot(at_card_sigma, card.reading->pose_sigma, common_light), by_strays);
  summary.scale_sigma = lamp.scale_sigma;
  std::vector<std::pair<std::string, double>> sigmas{{"card's pixels, lights and drift", at_card_sigma},
                                                     {"card's pose", card.reading->pose_sigma},
                                                     {"sphere line", common_light}};
  if (alone) sigmas.emplace_back("stray lights", by_strays);
  add_shares(summary, sigmas);
  return lamp;
}

}  // namespace lumitexel
