#include "processing/image/dark_frames.h"

#include <algorithm>
#include <cmath>

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
        frame.bits != frames[0].bits || !(frame.reported == frames[0].reported) || frame.samples.size() != pixels) {
      throw BadInput("dark frames", "frames of different size, bit depth or settings", "repetitions of one exposure");
    }
  }
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

double MasterDark::variance_of_mean_dn2(std::size_t pixel, const LinearSensor& sensor) const {
  const double excess_dn = std::max(0.0, static_cast<double>(mean_dn[pixel]) - median_dn);
  return (pixel_variance_dn2 + excess_dn / sensor.electrons_per_dn) / repetitions;
}

MasterDark make_master_dark(const std::vector<Frame>& repetitions, const LinearSensor& sensor) {
  check_equal(repetitions);
  MasterDark dark;
  dark.settings = repetitions[0].reported;
  dark.width_px = repetitions[0].width_px;
  dark.height_px = repetitions[0].height_px;
  dark.repetitions = static_cast<int>(repetitions.size());
  average(repetitions, dark);
  flag_hot(dark, sensor);
  dark.pixel_variance_dn2 = pooled_variance(repetitions, dark, sensor);
  return dark;
}

const MasterDark& DarkLibrary::matching(const CameraSettings& settings, int width_px, int height_px) const {
  for (const MasterDark& dark : darks_) {
    if (dark.settings == settings && dark.width_px == width_px && dark.height_px == height_px) return dark;
  }
  throw BadInput("dark frames",
                 "none with exposure " + std::to_string(settings.exposure_s) + " s, gain " +
                     std::to_string(settings.gain_db) + " dB, " + std::to_string(width_px) + "x" +
                     std::to_string(height_px),
                 "dark frames for every exposure time used");
}

}  // namespace lumitexel
