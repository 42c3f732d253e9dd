#include "processing/image/exposure_pair.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kFewestPixels = 200;
constexpr double kClearSigmas = 6.0;   // of the merged signal's distance from clipping
constexpr double kTrimSigmas = 3.0;
constexpr double kTrimmedVariance = 0.973337;  // of a normal distribution cut at three standard deviations, in its own
constexpr double kMadToSigma = 1.4826;
constexpr double kSurelyClipped = 1.25;

// expected_dn: the difference's standard deviation by the sensor's description. A bin spans a range of signals; trimmed in
// these units its differences are of one kind, where in DN a mixture of narrow and wide ones would lose its wide ones.
struct PixelPair {
  float signal_dn, difference_dn, expected_dn;
  double normalised() const { return static_cast<double>(difference_dn) / static_cast<double>(expected_dn); }
};

double signal_dn(const DarkedExposure& e, std::size_t i) {
  return static_cast<double>(e.frame->samples[i]) - static_cast<double>(e.dark->mean_dn[i]);
}

template <typename Values, typename Of>
double median_of(Values& values, const Of& of) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end(), [&](const auto& a, const auto& b) { return of(a) < of(b); });
  return of(*middle);
}

DifferenceBin bin_of(std::vector<PixelPair> pixels) {
  DifferenceBin bin;
  bin.pixels = static_cast<double>(pixels.size());
  double expected_variance_dn2 = 0.0;
  for (const PixelPair& p : pixels) {
    bin.signal_dn += static_cast<double>(p.signal_dn) / bin.pixels;
    expected_variance_dn2 += static_cast<double>(p.expected_dn) * static_cast<double>(p.expected_dn) / bin.pixels;
  }
  double centre = median_of(pixels, [](const PixelPair& p) { return p.normalised(); });
  double sigma = kMadToSigma * median_of(pixels, [&](const PixelPair& p) { return std::abs(p.normalised() - centre); });
  for (int pass = 0; pass < 8; ++pass) {
    double sum = 0.0, squares = 0.0, differences = 0.0, count = 0.0;
    for (const PixelPair& p : pixels) {
      const double off = p.normalised() - centre;
      if (std::abs(off) > kTrimSigmas * sigma) continue;
      sum += off;
      squares += off * off;
      differences += static_cast<double>(p.difference_dn);
      count += 1.0;
    }
    if (count < 2.0) break;
    const double mean = sum / count;
    centre += mean;
    const double variance = (squares / count - mean * mean) * count / (count - 1.0) / kTrimmedVariance;
    bin.variance_dn2 = variance * expected_variance_dn2;
    bin.median_dn = differences / count;
    bin.trimmed = bin.pixels - count;
    const double before = sigma;
    sigma = std::sqrt(variance);
    if (std::abs(sigma - before) < 1e-6 * sigma) break;
  }
  return bin;
}

}  // namespace

PairBins difference_bins(const DarkedExposure& shorter, const DarkedExposure& longer, const LinearSensor& sensor,
                         int bins) {
  PairBins found;
  found.ratio = longer.frame->reported.exposure_s / shorter.frame->reported.exposure_s;
  const double a = found.ratio, range_dn = sensor.usable_below_dn() - sensor.black_level_dn;
  std::vector<PixelPair> pixels;
  for (std::size_t i = 0; i < shorter.frame->samples.size(); ++i) {
    if (shorter.dark->hot[i] || longer.dark->hot[i]) continue;
    const double x1 = signal_dn(shorter, i), x2 = signal_dn(longer, i);
    // A plain estimate first, for the weights: a weighted one's noise would correlate with its own weights.
    const double plain = std::max(0.0, (x1 + x2) / (1.0 + 1.0 / a));
    const double v1 = sensor.variance_dn2(plain / a), v2 = sensor.variance_dn2(plain);
    const double merged = (x1 * a / (a * a * v1) + x2 / v2) / (1.0 / (a * a * v1) + 1.0 / v2);
    const double dark2_dn = static_cast<double>(longer.dark->mean_dn[i]) - sensor.black_level_dn;
    const double merged_sigma = std::sqrt(1.0 / (1.0 / (a * a * v1) + 1.0 / v2));
    if (merged + dark2_dn > range_dn - kClearSigmas * (std::sqrt(v2) + merged_sigma)) continue;
    const double expected = std::sqrt(a * a * sensor.variance_dn2(std::max(0.0, merged) / a) + sensor.variance_dn2(std::max(0.0, merged)));
    pixels.push_back({static_cast<float>(merged), static_cast<float>(a * x1 - x2), static_cast<float>(expected)});
  }
  std::sort(pixels.begin(), pixels.end(), [](const PixelPair& p, const PixelPair& q) {
    return p.signal_dn != q.signal_dn ? p.signal_dn < q.signal_dn : p.difference_dn < q.difference_dn;
  });
  const auto wanted = std::min<std::size_t>(static_cast<std::size_t>(bins), pixels.size() / static_cast<std::size_t>(kFewestPixels));
  for (std::size_t b = 0; b < wanted; ++b) {
    const auto from = pixels.begin() + static_cast<std::ptrdiff_t>(pixels.size() * b / wanted);
    const auto to = pixels.begin() + static_cast<std::ptrdiff_t>(pixels.size() * (b + 1) / wanted);
    found.bins.push_back(bin_of({from, to}));
  }
  return found;
}

std::vector<std::uint16_t> saturated_samples(const DarkedExposure& shorter, const DarkedExposure& longer,
                                             const LinearSensor& sensor) {
  std::vector<std::uint16_t> samples;
  const double a = longer.frame->reported.exposure_s / shorter.frame->reported.exposure_s;
  const double range_dn = sensor.clip_dn - sensor.black_level_dn;
  for (std::size_t i = 0; i < shorter.frame->samples.size(); ++i) {
    if (shorter.dark->hot[i] || longer.dark->hot[i]) continue;
    const double x1 = signal_dn(shorter, i), noise = kClearSigmas * std::sqrt(sensor.variance_dn2(x1));
    if ((x1 - noise) * a > kSurelyClipped * range_dn) samples.push_back(longer.frame->samples[i]);
  }
  return samples;
}

}  // namespace lumitexel
