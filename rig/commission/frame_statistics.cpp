#include "rig/commission/frame_statistics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr std::size_t kFewestPixels = 200;  // of a group: its variance is then known to 10 %

}  // namespace

double mean_of(Samples samples) {
  double sum = 0.0;
  for (const std::uint16_t sample : samples) sum += sample;
  return samples.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / static_cast<double>(samples.size());
}

double quantile_of(Samples samples, double share) {
  std::vector<std::uint16_t> sorted(samples.begin(), samples.end());
  const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(sorted.size() - 1));
  std::nth_element(sorted.begin(), sorted.begin() + place, sorted.end());
  return sorted[static_cast<std::size_t>(place)];
}

std::vector<NoiseGroup> noise_groups(Samples first, Samples second, double black_dn, double highest_dn, int groups) {
  std::vector<NoiseGroup> found(static_cast<std::size_t>(groups));
  const double range = highest_dn - black_dn;
  for (std::size_t i = 0; i < first.size(); ++i) {
    const double mean = 0.5 * (first[i] + second[i]) - black_dn;
    if (!(mean < range)) continue;
    // Square-root spacing: even steps in noise.
    const double place = std::sqrt(std::max(0.0, mean) / range) * groups;
    NoiseGroup& group = found[std::min(static_cast<std::size_t>(place), found.size() - 1)];
    const double difference = static_cast<double>(first[i]) - second[i];
    group.mean_dn += mean;
    group.variance_dn2 += 0.5 * difference * difference;
    ++group.pixels;
  }
  std::erase_if(found, [](const NoiseGroup& group) { return group.pixels < kFewestPixels; });
  for (NoiseGroup& group : found) {
    const auto n = static_cast<double>(group.pixels);
    group.mean_dn /= n;
    group.variance_dn2 /= n;
    group.sigma_dn2 = group.variance_dn2 * std::sqrt(2.0 / n);
  }
  return found;
}

PhotonTransfer fit_photon_transfer(const std::vector<NoiseGroup>& groups) {
  if (groups.size() < 3) throw Error("photon transfer: fewer than three levels of signal; light the scene more evenly");
  double w = 0, wx = 0, wy = 0, wxx = 0, wxy = 0;
  for (const NoiseGroup& group : groups) {
    const double weight = 1.0 / (group.sigma_dn2 * group.sigma_dn2 + 1e-12);
    w += weight;
    wx += weight * group.mean_dn;
    wy += weight * group.variance_dn2;
    wxx += weight * group.mean_dn * group.mean_dn;
    wxy += weight * group.mean_dn * group.variance_dn2;
  }
  const double determinant = w * wxx - wx * wx;
  const double slope = (w * wxy - wx * wy) / determinant;
  if (!(slope > 0.0)) throw Error("photon transfer: the noise does not grow with the signal; is the lamp on?");
  const double slope_sigma = std::sqrt(w / determinant);
  return {{1.0 / slope, slope_sigma / (slope * slope)}, (wxx * wy - wx * wxy) / determinant};
}

Line fit_line(const std::vector<CurvePoint>& points) {
  const auto n = static_cast<double>(points.size());
  double mean_x = 0, mean_y = 0, xx = 0, xy = 0, rest = 0;
  for (const CurvePoint& point : points) {
    mean_x += point.x / n;
    mean_y += point.y / n;
  }
  for (const CurvePoint& point : points) {
    xx += (point.x - mean_x) * (point.x - mean_x);
    xy += (point.x - mean_x) * (point.y - mean_y);
  }
  Line line;
  line.slope.value = xy / xx;
  line.offset = mean_y - line.slope.value * mean_x;
  for (const CurvePoint& point : points) rest += std::pow(point.y - line.offset - line.slope.value * point.x, 2);
  line.residual_sigma = points.size() > 2 ? std::sqrt(rest / (n - 2.0)) : 0.0;
  line.slope.sigma = line.residual_sigma / std::sqrt(xx);
  return line;
}

double median_of(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double deviation_of(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  double sum = 0.0;
  for (const double value : values) sum += (value - mean) * (value - mean);
  return std::sqrt(sum / static_cast<double>(values.size() - 1));
}

}  // namespace lumitexel
