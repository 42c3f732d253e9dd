#include "processing/image/hdr_merge.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr double kDarkSigmas = 3.0;

struct Exposure {
  const Frame* frame = nullptr;
  const MasterDark* dark = nullptr;
  double time_s = 0;
};

struct PixelResult {
  double value = 0, variance = 0;
  std::uint8_t flags = 0;
};

double signal_dn(const Exposure& exposure, std::size_t i) {
  return static_cast<double>(exposure.frame->samples[i]) - static_cast<double>(exposure.dark->mean_dn[i]);
}

// Variance of the rate that one exposure measures where the true rate is `rate`.
double rate_variance(const Exposure& exposure, std::size_t i, double rate, const LinearSensor& sensor) {
  const double dark_dn = std::max(0.0, static_cast<double>(exposure.dark->mean_dn[i]) - sensor.black_level_dn);
  const double sample = sensor.variance_dn2(std::max(rate, 0.0) * exposure.time_s + dark_dn);
  return (sample + exposure.dark->variance_of_mean_dn2(i, sensor)) / (exposure.time_s * exposure.time_s);
}

PixelResult merge_pixel(const std::vector<Exposure>& ascending, std::size_t i, const LinearSensor& sensor) {
  const double usable_below = sensor.usable_below_dn();
  const auto unclipped = [&](const Exposure& e) { return e.frame->samples[i] < usable_below; };
  const auto usable = [&](const Exposure& e) { return unclipped(e) && !e.dark->hot[i]; };
  PixelResult result;
  if (std::none_of(ascending.begin(), ascending.end(), usable)) {
    const Exposure& shortest = ascending.front();
    const bool clipped = std::none_of(ascending.begin(), ascending.end(), unclipped);
    result.flags = clipped ? kPixelSaturated : kPixelDefective;
    result.value = signal_dn(shortest, i) / shortest.time_s;
    result.variance = rate_variance(shortest, i, result.value, sensor);
    return result;
  }
  double counts = 0.0, time_s = 0.0;
  const Exposure* longest = nullptr;
  for (const Exposure& exposure : ascending) {
    if (!usable(exposure)) continue;
    counts += signal_dn(exposure, i);
    time_s += exposure.time_s;
    longest = &exposure;
  }
  const double first_estimate = counts / time_s;
  double weighted = 0.0, weights = 0.0;
  for (const Exposure& exposure : ascending) {
    if (!usable(exposure)) continue;
    const double weight = 1.0 / rate_variance(exposure, i, first_estimate, sensor);
    weighted += weight * signal_dn(exposure, i) / exposure.time_s;
    weights += weight;
  }
  result.value = weighted / weights;
  result.variance = 1.0 / weights;
  if (result.value < kDarkSigmas * std::sqrt(rate_variance(*longest, i, 0.0, sensor))) result.flags |= kPixelDark;
  return result;
}

std::vector<Exposure> matched(const std::vector<Frame>& frames, const DarkLibrary& darks) {
  if (frames.empty()) throw BadInput("bracket", "no frames", "at least one exposure");
  std::vector<Exposure> exposures;
  for (const Frame& frame : frames) {
    if (frame.width_px != frames[0].width_px || frame.height_px != frames[0].height_px ||
        frame.mosaic != frames[0].mosaic) {
      throw BadInput("bracket", "frames of different size or mosaic", "exposures by one camera");
    }
    exposures.push_back(
        {&frame, &darks.matching(frame.reported, frame.width_px, frame.height_px), frame.reported.exposure_s});
  }
  std::stable_sort(exposures.begin(), exposures.end(),
                   [](const Exposure& a, const Exposure& b) { return a.time_s < b.time_s; });
  return exposures;
}

}  // namespace

MosaicRadiance merge_bracket(const std::vector<Frame>& frames, const DarkLibrary& darks, const LinearSensor& sensor) {
  const std::vector<Exposure> exposures = matched(frames, darks);
  MosaicRadiance merged;
  merged.width = frames[0].width_px;
  merged.height = frames[0].height_px;
  merged.mosaic = frames[0].mosaic;
  const std::size_t pixels = frames[0].samples.size();
  merged.value.resize(pixels);
  merged.variance.resize(pixels);
  merged.flags.resize(pixels);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pixels), [&](const tbb::blocked_range<std::size_t>& range) {
    for (std::size_t i = range.begin(); i != range.end(); ++i) {
      const PixelResult pixel = merge_pixel(exposures, i, sensor);
      merged.value[i] = static_cast<float>(pixel.value);
      merged.variance[i] = static_cast<float>(pixel.variance);
      merged.flags[i] = pixel.flags;
    }
  });
  return merged;
}

}  // namespace lumitexel
