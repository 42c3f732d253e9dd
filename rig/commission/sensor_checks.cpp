#include "rig/commission/sensor_checks.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kLongDark_s = 2.0;
constexpr int kLadder = 8;         // exposures, each half the next
constexpr int kNoiseGroups = 24;
constexpr int kStabilityFrames = 8;
constexpr double kNoiseSpread = 8.0;  // of a thousand values of a normal distribution, in its sigmas
constexpr double kLeast = 0.05, kMost = 0.8;  // share of saturation within which linearity is judged

void check_darks(TestBench& bench, SensorFindings& found) {
  bench.light_only(nullptr);
  const CameraLimits limits = bench.devices().camera->limits();
  const Frame first = bench.settled_shot(limits.exposure_min_s), second = bench.settled_shot(limits.exposure_min_s);
  double sum = 0.0;
  for (std::size_t i = 0; i < first.samples.size(); ++i) {
    sum += 0.5 * std::pow(static_cast<double>(first.samples[i]) - second.samples[i], 2);
  }
  const auto pixels = static_cast<double>(first.samples.size());
  const double variance = std::max(0.0, sum / pixels - kQuantisation_dn2);
  found.read_noise_dn = {std::sqrt(variance), std::sqrt(variance / (2.0 * pixels))};
  found.black_level_dn = {0.5 * (mean_of(first.samples) + mean_of(second.samples)),
                          std::sqrt((variance + kQuantisation_dn2) / (2.0 * pixels))};
}

void check_dark_current(TestBench& bench, SensorFindings& found) {
  bench.light_only(nullptr);
  const CameraLimits limits = bench.devices().camera->limits();
  const double exposure_s = std::min(kLongDark_s, limits.exposure_max_s);
  const Frame dark = bench.settled_shot(exposure_s);
  const double noise = std::sqrt(found.read_noise_dn.value * found.read_noise_dn.value + kQuantisation_dn2);
  // The median of integers is too coarse; the mean of the pixels that are not hot is not.
  double sum = 0.0;
  std::size_t calm = 0;
  for (const std::uint16_t sample : dark.samples) {
    if (sample > found.black_level_dn.value + 10.0 * noise) continue;
    sum += sample - found.black_level_dn.value;
    ++calm;
  }
  const auto n = static_cast<double>(calm);
  const double per_s = found.electrons_per_dn.value / exposure_s;
  found.dark_current_e_per_s = {per_s * sum / n, per_s * std::hypot(noise / std::sqrt(n), found.black_level_dn.sigma)};
  found.hot_pixel_share = 1.0 - n / static_cast<double>(dark.samples.size());
}

// Pixels that the longest exposure of the ladder leaves in the middle of the range: bright and far from clipping.
std::vector<std::size_t> well_lit(const Frame& longest, double black_dn, double top_dn) {
  std::vector<std::size_t> pixels;
  for (std::size_t i = 0; i < longest.samples.size(); ++i) {
    const double share = (longest.samples[i] - black_dn) / (top_dn - black_dn);
    if (share > 0.3 && share < kMost) pixels.push_back(i);
  }
  return pixels;
}

double mean_over(const Frame& frame, const std::vector<std::size_t>& pixels, double black_dn) {
  double sum = 0.0;
  for (const std::size_t i : pixels) sum += frame.samples[i] - black_dn;
  return sum / static_cast<double>(pixels.size());
}

// Up the ladder and down again, so that a lamp's steady drift cancels; each rung's two frames give its noise as well.
void check_ladder(TestBench& bench, double longest_s, SensorFindings& found) {
  const double black = found.black_level_dn.value;
  const std::vector<std::size_t> pixels = well_lit(bench.settled_shot(longest_s), black, bench.top_dn());
  std::vector<double> exposures;
  for (int i = kLadder - 1; i >= 0; --i) {
    const double exposure_s = longest_s * std::ldexp(1.0, -i);
    if (exposure_s >= bench.devices().camera->limits().exposure_min_s) exposures.push_back(exposure_s);
  }
  std::vector<Frame> up;
  for (const double exposure_s : exposures) up.push_back(bench.settled_shot(exposure_s));
  std::vector<NoiseGroup> groups;
  std::vector<CurvePoint> signals;
  for (std::size_t i = exposures.size(); i-- > 0;) {
    const Frame down = bench.settled_shot(exposures[i]);
    const auto more =
        noise_groups(up[i].samples, down.samples, black, black + kMost * (bench.top_dn() - black), kNoiseGroups);
    groups.insert(groups.end(), more.begin(), more.end());
    const double signal = 0.5 * (mean_over(up[i], pixels, black) + mean_over(down, pixels, black));
    signals.push_back({up[i].reported.exposure_s, signal});
  }
  found.electrons_per_dn = fit_photon_transfer(groups).electrons_per_dn;
  for (const NoiseGroup& group : groups) found.photon_transfer.push_back({group.mean_dn, group.variance_dn2});
  // The longest has the least noise: it sets the slope.
  const double slope = signals.front().y / signals.front().x;
  for (const CurvePoint& point : signals) {
    if (point.y < kLeast * (bench.top_dn() - black)) continue;
    const double deviation = 100.0 * (point.y / (slope * point.x) - 1.0);
    found.linearity.push_back({point.x, deviation});
    found.nonlinearity_percent = std::max(found.nonlinearity_percent, std::abs(deviation));
  }
  std::vector<double> levels;
  for (int i = 0; i < kStabilityFrames; ++i) levels.push_back(mean_over(bench.settled_shot(longest_s), pixels, black));
  found.lamp_instability_percent = 100.0 * deviation_of(levels) / levels.front();
}

void check_saturation(TestBench& bench, double longest_s, SensorFindings& found) {
  const double exposure_s = std::min(longest_s * 20.0, bench.devices().camera->limits().exposure_max_s);
  const Frame full = bench.settled_shot(exposure_s);
  const double top = quantile_of(full.samples, 0.999);
  // The brightest hundredth of a saturated picture is one value and its noise; one that is not saturated goes on beyond.
  const double spread = top - quantile_of(full.samples, 0.99);
  if (spread > kNoiseSpread * std::hypot(found.read_noise_dn.value, 1.0)) return;
  const double depth = top - found.black_level_dn.value;
  found.saturation_dn = Measured{top, 0.0};
  found.full_well_e = Measured{depth * found.electrons_per_dn.value, depth * found.electrons_per_dn.sigma};
}

}  // namespace

SensorFindings check_sensor(TestBench& bench) {
  SensorFindings found;
  check_darks(bench, found);
  bench.light_only(bench.devices().point_light.get());
  const double longest_s = bench.exposure_for(0.6);
  check_ladder(bench, longest_s, found);
  check_saturation(bench, longest_s, found);
  found.read_noise_e = {found.read_noise_dn.value * found.electrons_per_dn.value,
                        std::hypot(found.read_noise_dn.sigma * found.electrons_per_dn.value,
                                   found.read_noise_dn.value * found.electrons_per_dn.sigma)};
  check_dark_current(bench, found);
  return found;
}

}  // namespace lumitexel
