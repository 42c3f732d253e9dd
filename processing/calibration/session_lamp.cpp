#include "processing/calibration/session_lamp.h"

#include <cmath>
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

// A reading freed of the lamp's pattern: the mean over the channels' logarithms, and each channel's distance from it.
struct FreedReading {
  double log_mean = 0;
  std::vector<double> log_ratio;
  double sigma = 0;  // of log_mean, without what all readings share
};

FreedReading freed(const TimedReading& timed, const Eigen::Isometry3d& lamp_from_rig, const LampPattern& pattern) {
  const CardReading& reading = *timed.reading;
  const double factor = pattern.factor(lamp_from_rig * reading.card_in_rig);
  FreedReading result;
  for (const double intensity : reading.intensity) result.log_ratio.push_back(std::log(intensity / factor));
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

void add_shares(CalibrationSummary& summary, const std::vector<std::pair<std::string, double>>& sigmas) {
  double total = 0.0;
  for (const auto& [source, sigma] : sigmas) total += sigma * sigma;
  for (const auto& [source, sigma] : sigmas) {
    if (total > 0.0) summary.shares.push_back({"scale", source, sigma * sigma / total});
  }
}

}  // namespace

LampPattern measure_lamp_pattern(const CapturedFrames& frames, const CapturedInputs& in, const RadianceReader& reader,
                                 const SessionLens& lens, const SessionLights& lights,
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
  std::vector<PatternSample> samples;
  for (const WhitePatch& patch : white_patches(reader.read(bracket), lens.camera, board->second, *in.rig.board)) {
    samples.push_back({0, lamp_from_camera * patch.position_in_camera,
                       lamp_from_camera.linear() * patch.normal_in_camera, patch.radiance, patch.variance});
  }
  const PatternFit fit = fit_lamp_pattern(samples);
  summary.lamp.pattern_parameters = fit.parameters;
  if (fit.parameters == 0) return {};
  const double angle = 10.0 * std::numbers::pi / 180.0;
  summary.lamp.at_10_deg = fit.pattern.factor({std::sin(angle), 0.0, std::cos(angle)});
  return fit.pattern;
}

SessionLamp measure_lamp(const CapturedInputs& in, const SessionLights& lights, const LampPattern& pattern,
                         const std::vector<TimedReading>& views, const TimedReading& card,
                         const CalibrationOptions& options, CalibrationSummary& summary) {
  std::vector<CardSample> samples;
  std::vector<FreedReading> readings;
  const auto add = [&](const TimedReading& timed) {
    readings.push_back(freed(timed, lamp_frame(in, lights, timed.light_in_rig), pattern));
    samples.push_back({timed.time_s, std::exp(readings.back().log_mean), readings.back().sigma});
  };
  add(card);
  if (options.takes(CalibrationStep::LampDrift)) {
    for (const TimedReading& view : views) {
      if (view.reading) add(view);
    }
  }
  const LampDrift drift(samples);
  const std::vector<double> ratios = channel_ratios(readings, drift.used());

  SessionLamp lamp;
  lamp.pattern = pattern;
  for (const TimedReading& view : views) {
    const double mean = drift.intensity(view.time_s).factor;
    std::vector<double>& channels = lamp.intensity.emplace_back();
    for (const double ratio : ratios) channels.push_back(mean * ratio);
    lamp.lamp_from_rig.push_back(lamp_frame(in, lights, view.light_in_rig).linear());
    const LampFactor factor = drift.relative(view.time_s, card.time_s);
    summary.lamp.factor.push_back(factor.factor);
    summary.lamp.factor_sigma.push_back(factor.sigma);
  }
  const LampFactor at_card = drift.intensity(card.time_s);
  const double at_card_sigma = at_card.sigma / at_card.factor;
  for (const double ratio : ratios) summary.intensity.push_back(at_card.factor * ratio);
  summary.gray_card_pixel_scatter = card.reading->pixel_scatter;
  summary.lamp.drifts = drift.drifts();
  summary.lamp.card_views = static_cast<int>(samples.size()) - 1;
  for (const bool used : drift.used()) summary.lamp.card_outliers += !used;
  // Lights are all wrong by as much where the sphere line is.
  const double common_light =
      2.0 * lights.shared_sigma_m / (card.light_in_rig - card.reading->card_in_rig).norm();
  lamp.scale_sigma = std::hypot(at_card_sigma, card.reading->pose_sigma, common_light);
  summary.scale_sigma = lamp.scale_sigma;
  add_shares(summary, {{"card's pixels, lights and drift", at_card_sigma},
                       {"card's pose", card.reading->pose_sigma},
                       {"sphere line", common_light}});
  return lamp;
}

}  // namespace lumitexel
