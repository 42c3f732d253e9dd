#include "processing/image/dark_frames.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "drivers/error.h"

namespace lumitexel {
namespace {

// Healthy pixels spread by read noise and by the sensor's own unevenness; 10 standard deviations leave room for the
// latter and yet no healthy pixel of any sensor of 10^8 pixels would be flagged by the former.
constexpr double kHotSigmas = 10.0;
constexpr double kMadToSigma = 1.4826;  // of a normal distribution

float median(std::vector<float> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

void check_equal(const std::vector<Frame>& frames) {
  if (frames.empty()) throw BadInput("dark frames", "none", "at least one for each exposure time");
  for (const Frame& frame : frames) {
    const std::size_t pixels = static_cast<std::size_t>(frame.width_px) * static_cast<std::size_t>(frame.height_px);
    if (frame.width_px != frames[0].width_px || frame.height_px != frames[0].height_px ||
        frame.bits != frames[0].bits || frame.mosaic != frames[0].mosaic || !(frame.reported == frames[0].reported) ||
        frame.samples.size() != pixels || pixels == 0) {
      throw BadInput("dark frames", "frames of different size, bit depth, mosaic or settings",
                     "repetitions of one exposure");
    }
  }
}

std::optional<double> mean_temperature_c(const std::vector<Frame>& frames) {
  double sum = 0.0;
  for (const Frame& frame : frames) {
    if (!known_temperature_c(frame)) return std::nullopt;
    sum += frame.sensor_temperature_c;
  }
  const double mean = sum / static_cast<double>(frames.size());
  for (const Frame& frame : frames) {
    if (std::abs(frame.sensor_temperature_c - mean) > kDarkTemperatureWindow_k) {
      throw BadInput("dark frames", "one at " + std::to_string(frame.sensor_temperature_c) + " degrees Celsius, their mean " + std::to_string(mean),
                     "repetitions at one temperature (within " + std::to_string(kDarkTemperatureWindow_k) + " K)");
    }
  }
  return mean;
}

void average(const std::vector<Frame>& frames, MasterDark& dark) {
  const double n = static_cast<double>(frames.size());
  dark.mean_dn.resize(frames[0].samples.size());
  for (std::size_t i = 0; i < dark.mean_dn.size(); ++i) {
    double sum = 0.0;
    for (const Frame& frame : frames) sum += frame.samples[i];
    dark.mean_dn[i] = static_cast<float>(sum / n);
  }
}

void flag_hot(MasterDark& dark, const LinearSensor& sensor) {
  dark.median_dn = median(dark.mean_dn);
  std::vector<float> deviations(dark.mean_dn);
  for (float& value : deviations) value = std::abs(value - static_cast<float>(dark.median_dn));
  // Integers may agree so well that the median deviation is zero; the noise model says what is possible.
  const double possible = std::sqrt(sensor.variance_dn2(dark.median_dn - sensor.black_level_dn) / dark.repetitions);
  const double sigma = std::max(kMadToSigma * static_cast<double>(median(std::move(deviations))), possible);
  dark.hot.assign(dark.mean_dn.size(), 0);
  for (std::size_t i = 0; i < dark.hot.size(); ++i) {
    dark.hot[i] = std::abs(dark.mean_dn[i] - dark.median_dn) > kHotSigmas * sigma ? 1 : 0;
    dark.hot_count += dark.hot[i];
  }
}

double pooled_variance(const std::vector<Frame>& frames, const MasterDark& dark, const LinearSensor& sensor) {
  if (frames.size() < 2) return sensor.variance_dn2(dark.median_dn - sensor.black_level_dn);
  double sum = 0.0;
  std::int64_t count = 0;
  for (std::size_t i = 0; i < dark.mean_dn.size(); ++i) {
    if (dark.hot[i]) continue;
    ++count;
    for (const Frame& frame : frames) {
      const double difference = frame.samples[i] - static_cast<double>(dark.mean_dn[i]);
      sum += difference * difference;
    }
  }
  return count == 0 ? sensor.variance_dn2(0.0)
                    : sum / (static_cast<double>(count) * static_cast<double>(frames.size() - 1));
}

}  // namespace

std::optional<double> known_temperature_c(const Frame& frame) {
  if (frame.sensor_temperature_c == 0.0 || !std::isfinite(frame.sensor_temperature_c)) return std::nullopt;
  return frame.sensor_temperature_c;
}

double MasterDark::variance_of_mean_dn2(std::size_t pixel, const LinearSensor& sensor) const {
  const double excess_dn = std::max(0.0, static_cast<double>(mean_dn[pixel]) - median_dn) / scale;
  const double plain = (pixel_variance_dn2 + excess_dn / sensor.electrons_per_dn) / repetitions;
  if (scale_sigma == 0.0) return plain;
  const double current_dn = (static_cast<double>(mean_dn[pixel]) - sensor.black_level_dn) / scale;
  return plain * scale * scale + current_dn * current_dn * scale_sigma * scale_sigma;
}

MasterDark make_master_dark(const std::vector<Frame>& repetitions, const LinearSensor& sensor) {
  check_equal(repetitions);
  MasterDark dark;
  dark.settings = repetitions[0].reported;
  dark.width_px = repetitions[0].width_px;
  dark.height_px = repetitions[0].height_px;
  dark.bits = repetitions[0].bits;
  dark.mosaic = repetitions[0].mosaic;
  dark.temperature_c = mean_temperature_c(repetitions);
  dark.repetitions = static_cast<int>(repetitions.size());
  average(repetitions, dark);
  flag_hot(dark, sensor);
  dark.pixel_variance_dn2 = pooled_variance(repetitions, dark, sensor);
  return dark;
}

std::vector<std::vector<Frame>> grouped_by_temperature(std::vector<Frame> repetitions) {
  const auto order_c = [](const Frame& f) { return known_temperature_c(f).value_or(-1e9); };
  std::stable_sort(repetitions.begin(), repetitions.end(),
                   [&](const Frame& a, const Frame& b) { return order_c(a) < order_c(b); });
  std::vector<std::vector<Frame>> groups;
  for (Frame& frame : repetitions) {
    if (groups.empty() || order_c(frame) - order_c(groups.back().front()) > kDarkTemperatureWindow_k) groups.emplace_back();
    groups.back().push_back(std::move(frame));
  }
  return groups;
}

DarkMatch DarkLibrary::matching(const Frame& frame) const {
  const std::optional<double> frame_c = known_temperature_c(frame);
  DarkMatch best;
  double best_gap_k = 0.0;
  for (const MasterDark& dark : darks_) {
    if (!(dark.settings == frame.reported) || dark.width_px != frame.width_px || dark.height_px != frame.height_px ||
        dark.bits != frame.bits || dark.mosaic != frame.mosaic) {
      continue;
    }
    const bool known = frame_c && dark.temperature_c;
    // One of unknown temperature comes after all that are known.
    const double gap_k = known ? std::abs(*frame_c - *dark.temperature_c) : std::numeric_limits<double>::max();
    if (best.dark && gap_k >= best_gap_k) continue;
    best_gap_k = gap_k;
    best.dark = &dark;
    best.temperature = !known                                 ? DarkMatch::Temperature::Unknown
                       : gap_k <= kDarkTemperatureWindow_k ? DarkMatch::Temperature::Same
                                                              : DarkMatch::Temperature::Drifted;
  }
  if (best.dark) return best;
  throw BadInput("dark frames",
                 "none with exposure " + std::to_string(frame.reported.exposure_s) + " s, gain " +
                     std::to_string(frame.reported.gain_db) + " dB, " + std::to_string(frame.width_px) + "x" +
                     std::to_string(frame.height_px) + ", " + std::to_string(frame.bits) + " bits, " +
                     to_string(frame.mosaic),
                 "dark frames for every exposure time used");
}

}  // namespace lumitexel
