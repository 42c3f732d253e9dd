#include "processing/image/exposure_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumitexel {
namespace {

constexpr double kFewestPixels = 200;
constexpr double kClearSigmas = 6.0;   // of the merged signal's distance from clipping
// Differences of rounded samples lie on a lattice: a cut at three standard deviations takes or leaves whole lines of it, and the
// variance jumps by some percent. At four there is next to nothing to take.
constexpr double kTrimSigmas = 4.0;
constexpr double kTrimmedVariance = 0.998929;  // of a normal distribution cut at four standard deviations, in its own
constexpr double kMadToSigma = 1.4826;
constexpr double kSurelyClipped = 1.25;
constexpr double kBright = 500.0;  // electrons: 5 % of noise

// around_dn: what the pixel's neighbours of the same colour see. expected_dn: the difference's standard deviation by the sensor's
// description; a bin spans a range of signals, and trimmed in these units its differences are of one kind.
struct PixelPair {
  float around_dn, signal_dn, difference_dn, expected_dn;
  double normalised() const { return static_cast<double>(difference_dn) / static_cast<double>(expected_dn); }
  double weight() const { return 1.0 / (static_cast<double>(expected_dn) * static_cast<double>(expected_dn)); }
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

// All of a bin's means are weighted by 1 / expected^2, the signal's like the variance's: then variance stays a straight line of
// signal whatever the bin spans and however wrong the expectation.
DifferenceBin bin_of(std::vector<PixelPair> pixels) {
  DifferenceBin bin;
  bin.pixels = static_cast<double>(pixels.size());
  double centre = median_of(pixels, [](const PixelPair& p) { return p.normalised(); });
  double sigma = kMadToSigma * median_of(pixels, [&](const PixelPair& p) { return std::abs(p.normalised() - centre); });
  for (int pass = 0; pass < 8; ++pass) {
    double sum = 0.0, squares = 0.0, weights = 0.0, signal = 0.0, difference = 0.0, count = 0.0;
    for (const PixelPair& p : pixels) {
      const double off = p.normalised() - centre, weight = p.weight();
      if (std::abs(off) > kTrimSigmas * sigma) continue;
      sum += off;
      squares += off * off;
      weights += weight;
      signal += weight * static_cast<double>(p.signal_dn);
      difference += weight * static_cast<double>(p.difference_dn);
      count += 1.0;
    }
    if (count < 2.0) break;
    const double mean = sum / count;
    centre += mean;
    const double variance = (squares / count - mean * mean) * count / (count - 1.0) / kTrimmedVariance;
    bin.variance_dn2 = variance * count / weights;
    bin.signal_dn = signal / weights;
    bin.median_dn = difference / weights;
    bin.trimmed = bin.pixels - count;
    const double before = sigma;
    sigma = std::sqrt(variance);
    if (std::abs(sigma - before) < 1e-6 * sigma) break;
  }
  return bin;
}

// The two exposures' signal together, of the eight neighbours of the same colour. It knows nothing of the pixel's own noise: what is
// chosen or weighted by the latter prefers one sign of it, and where most of a picture is dark that shows.
class Surroundings {
 public:
  Surroundings(const DarkedExposure& shorter, const DarkedExposure& longer, double ratio)
      : width_(shorter.frame->width_px), height_(shorter.frame->height_px),
        step_(shorter.frame->mosaic == Mosaic::Mono ? 1 : 2), signal_(shorter.frame->samples.size()) {
    for (std::size_t i = 0; i < signal_.size(); ++i) {
      const bool hot = shorter.dark->hot[i] || longer.dark->hot[i];
      const double both = (signal_dn(shorter, i) + signal_dn(longer, i)) / (1.0 + 1.0 / ratio);
      signal_[i] = hot ? std::numeric_limits<float>::quiet_NaN() : static_cast<float>(both);
    }
  }

  double at(std::size_t i) const {
    const int x = static_cast<int>(i % static_cast<std::size_t>(width_)), y = static_cast<int>(i / static_cast<std::size_t>(width_));
    double sum = 0.0, count = 0.0;
    for (int v = y - step_; v <= y + step_; v += step_) {
      for (int u = x - step_; u <= x + step_; u += step_) {
        if ((u == x && v == y) || u < 0 || v < 0 || u >= width_ || v >= height_) continue;
        const float one = signal_[static_cast<std::size_t>(v) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(u)];
        if (std::isnan(one)) continue;
        sum += static_cast<double>(one);
        count += 1.0;
      }
    }
    return count > 0.0 ? sum / count : 0.0;
  }

 private:
  int width_, height_, step_;
  std::vector<float> signal_;
};

}  // namespace

PairBins difference_bins(const DarkedExposure& shorter, const DarkedExposure& longer, const LinearSensor& sensor,
                         int bins) {
  PairBins found;
  found.ratio = longer.frame->reported.exposure_s / shorter.frame->reported.exposure_s;
  const double a = found.ratio, range_dn = sensor.usable_below_dn() - sensor.black_level_dn;
  const Surroundings surroundings(shorter, longer, a);
  // Of a x1 and x2, their darks included.
  const auto shorter_dn2 = [&](double signal) {
    return a * a * (sensor.variance_dn2(signal / a) + sensor.variance_dn2(0.0) / shorter.dark->repetitions);
  };
  const auto longer_dn2 = [&](double signal) { return sensor.variance_dn2(signal) + sensor.variance_dn2(0.0) / longer.dark->repetitions; };
  std::vector<PixelPair> pixels;
  for (std::size_t i = 0; i < shorter.frame->samples.size(); ++i) {
    if (shorter.dark->hot[i] || longer.dark->hot[i]) continue;
    const double x1 = signal_dn(shorter, i), x2 = signal_dn(longer, i), around = surroundings.at(i);
    const double v1 = shorter_dn2(around), v2 = longer_dn2(around);
    const double merged = (x1 * a / v1 + x2 / v2) / (1.0 / v1 + 1.0 / v2);
    const double dark2_dn = static_cast<double>(longer.dark->mean_dn[i]) - sensor.black_level_dn;
    const double margin_dn = kClearSigmas * (std::sqrt(sensor.variance_dn2(merged)) + std::sqrt(1.0 / (1.0 / v1 + 1.0 / v2)));
    if (merged + dark2_dn > range_dn - margin_dn) continue;
    // Bright pixels know themselves better than their neighbours do, and to so many digits that their noise prefers nothing.
    const double known = merged * sensor.electrons_per_dn > kBright ? merged : around;
    pixels.push_back({static_cast<float>(around), static_cast<float>(merged), static_cast<float>(a * x1 - x2),
                      static_cast<float>(std::sqrt(shorter_dn2(known) + longer_dn2(known)))});
  }
  std::stable_sort(pixels.begin(), pixels.end(),
                   [](const PixelPair& p, const PixelPair& q) { return p.around_dn < q.around_dn; });
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
