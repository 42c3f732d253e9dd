#include "processing/image/response/bracket_pixels.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr int kMostPixels = 160'000, kCandidates = 600'000;

void check_bracket(const std::vector<Frame>& bracket) {
  double shortest_s = 0.0, longest_s = 0.0;
  for (const Frame& frame : bracket) {
    const double exposure_s = frame.reported.exposure_s;
    if (frame.samples.size() != bracket[0].samples.size()) {
      throw BadInput("response", "frames of different size in one bracket", "exposures by one camera");
    }
    if (!(exposure_s > 0.0) || !std::isfinite(exposure_s)) {
      throw BadInput("response", "an exposure of " + std::to_string(exposure_s) + " s", "a positive time");
    }
    shortest_s = shortest_s == 0.0 ? exposure_s : std::min(shortest_s, exposure_s);
    longest_s = std::max(longest_s, exposure_s);
  }
  if (!(longest_s > shortest_s)) throw BadInput("response", "a bracket of one exposure time", "two that differ");
}

BracketPixel pixel_of(const std::vector<Frame>& bracket, std::size_t i, const LinearSensor& sensor,
                      const UnitSensor& unit) {
  BracketPixel pixel{{}, 0.0, true};
  double sum = 0.0, time_s = 0.0;
  for (const Frame& frame : bracket) {
    const double u = (frame.samples[i] - sensor.black_level_dn) / unit.range_dn;
    const bool censored = u >= unit.usable;
    pixel.samples.push_back({u, frame.reported.exposure_s, censored, !censored});
    if (censored) continue;
    sum += u;
    time_s += frame.reported.exposure_s;
  }
  pixel.rate = time_s > 0.0 ? sum / time_s : 0.0;
  return pixel;
}

}  // namespace

UnitSensor::UnitSensor(const LinearSensor& sensor) : range_dn(sensor.clip_dn - sensor.black_level_dn) {
  usable = (std::ceil(sensor.usable_below_dn()) - 0.5 - sensor.black_level_dn) / range_dn;
  shot = 1.0 / (sensor.electrons_per_dn * range_dn);
  reads = sensor.variance_dn2(0.0) / (range_dn * range_dn);
}

std::vector<BracketPixel> chosen_pixels(const std::vector<std::vector<Frame>>& brackets, const LinearSensor& sensor) {
  const UnitSensor unit(sensor);
  std::map<int, std::vector<BracketPixel>> by_brightness;
  std::size_t candidates = 0;
  for (const std::vector<Frame>& bracket : brackets) {
    check_bracket(bracket);
    const std::size_t share = kCandidates / brackets.size() + 1;
    const std::size_t stride = std::max<std::size_t>(1, bracket[0].samples.size() / share) | 1u;  // odd: all colours
    for (std::size_t i = 0; i < bracket[0].samples.size(); i += stride) {
      BracketPixel pixel = pixel_of(bracket, i, sensor, unit);
      if (!(pixel.rate > 0.0)) continue;
      by_brightness[static_cast<int>(std::floor(4.0 * std::log2(pixel.rate)))].push_back(std::move(pixel));
      ++candidates;
    }
  }
  std::vector<BracketPixel> chosen;
  if (candidates == 0) return chosen;
  const std::size_t quota = kMostPixels / by_brightness.size() + 1;
  for (auto& [brightness, pixels] : by_brightness) {
    const std::size_t stride = (pixels.size() + quota - 1) / quota;
    for (std::size_t i = 0; i < pixels.size(); i += stride) chosen.push_back(std::move(pixels[i]));
  }
  return chosen;
}

}  // namespace lumitexel
