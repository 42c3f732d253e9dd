#include "processing/image/dark_scale.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr double kExcessSigmas = 10.0;    // so that the dark's own noise is no regressor's error that matters (1 %)
constexpr double kSmoothSigmas = 4.0;     // spread of the inner six of eight neighbours; normal noise: 1.7
constexpr double kMedianVariance = 0.17;  // of eight normal values, in their variance
constexpr double kLeastScale = 0.05, kMostScale = 20.0, kCoarseStep = 1.05;
constexpr double kPriorPixels = 20.0;  // standard normal, added to the histogram: a few pixels' own would be spikes
constexpr double kLeastRelativeAccuracy = 0.3;

struct HotPixel {
  double contrast_dn = 0;    // sample minus median of neighbours
  double excess_dn = 0;      // of the dark over its median
  double surround_dn = 0;    // signal of the neighbours above black
  double dark_variance_dn2 = 0;
  double sigma_dn = 1;
};

// The density of standardised residuals on a grid, smoothed: its negative mean logarithm is the entropy.
class SmoothedDensity {
 public:
  SmoothedDensity(const std::vector<double>& values, double bandwidth, double reach)
      : reach_(reach), step_(bandwidth / 4.0), cells_(static_cast<std::size_t>(2.0 * reach / step_) + 2) {
    std::vector<double> histogram(cells_, 0.0);
    // Symmetric about zero, as noise about a smooth surrounding is: a density with a centre of its own would follow the
    // residuals' common shift, and only what differs from pixel to pixel would be left to tell the scale.
    for (const double value : values) {
      spread(histogram, value, 0.5);
      spread(histogram, -value, 0.5);
    }
    for (double x = -4.0; x <= 4.0; x += 0.25) {
      spread(histogram, x, kPriorPixels * 0.25 * std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi));
    }
    smooth(histogram, static_cast<double>(values.size()) + kPriorPixels);
  }

  double log_density(double value) const {
    const double at = place(value);
    const auto cell = static_cast<std::size_t>(at);
    const double part = at - static_cast<double>(cell);
    return (1.0 - part) * log_density_[cell] + part * log_density_[cell + 1];
  }

 private:
  double place(double value) const { return (std::clamp(value, -reach_, reach_) + reach_) / step_; }

  void spread(std::vector<double>& histogram, double value, double weight) const {
    const double at = place(value);
    const auto cell = static_cast<std::size_t>(at);
    const double part = at - static_cast<double>(cell);
    histogram[cell] += weight * (1.0 - part);
    histogram[cell + 1] += weight * part;
  }

  void smooth(const std::vector<double>& histogram, double total) {
    constexpr int kRadius = 16;  // four bandwidths of four cells
    std::array<double, 2 * kRadius + 1> kernel{};
    for (int k = -kRadius; k <= kRadius; ++k) kernel[static_cast<std::size_t>(k + kRadius)] = std::exp(-k * k / 32.0);
    double sum = 0.0;
    for (const double weight : kernel) sum += weight;
    const double floor = 1e-6;  // an outlier costs so much and no more
    log_density_.resize(cells_);
    for (std::size_t i = 0; i < cells_; ++i) {
      double density = 0.0;
      for (int k = -kRadius; k <= kRadius; ++k) {
        const auto j = static_cast<std::ptrdiff_t>(i) + k;
        if (j >= 0 && j < static_cast<std::ptrdiff_t>(cells_))
          density += histogram[static_cast<std::size_t>(j)] * kernel[static_cast<std::size_t>(k + kRadius)];
      }
      log_density_[i] = std::log(density / (sum * total * step_) + floor);
    }
  }

  double reach_, step_;
  std::size_t cells_;
  std::vector<double> log_density_;
};

std::vector<double> residuals(const std::vector<HotPixel>& pixels, double scale) {
  std::vector<double> values;
  values.reserve(pixels.size());
  for (const HotPixel& p : pixels) values.push_back((p.contrast_dn - scale * p.excess_dn) / p.sigma_dn);
  return values;
}

double negative_log_likelihood(const std::vector<double>& values, const SmoothedDensity& density) {
  double sum = 0.0;
  for (const double value : values) sum -= density.log_density(value);
  return sum;
}

double entropy(const std::vector<HotPixel>& pixels, double scale, double bandwidth, double reach) {
  const std::vector<double> values = residuals(pixels, scale);
  return negative_log_likelihood(values, SmoothedDensity(values, bandwidth, reach)) / static_cast<double>(values.size());
}

void set_sigmas(std::vector<HotPixel>& pixels, double scale, const LinearSensor& sensor) {
  for (HotPixel& p : pixels) {
    const double own = sensor.variance_dn2(p.surround_dn + scale * p.excess_dn);
    p.sigma_dn = std::sqrt(own + kMedianVariance * sensor.variance_dn2(p.surround_dn) +
                           scale * scale * p.dark_variance_dn2);
  }
}

// Adds the frame's pixel (x, y) if it is hot and in smooth surroundings.
void consider(const DarkedFrame& in, int x, int y, const LinearSensor& sensor, std::vector<HotPixel>& pixels) {
  const Frame& frame = *in.frame;
  const auto index = [&](int u, int v) {
    return static_cast<std::size_t>(v) * static_cast<std::size_t>(frame.width_px) + static_cast<std::size_t>(u);
  };
  const int reach = frame.mosaic == Mosaic::Mono ? 1 : 2;
  if (x < reach || y < reach || x + reach >= frame.width_px || y + reach >= frame.height_px) return;
  const std::size_t own = index(x, y);
  std::array<double, 8> around{};
  std::size_t n = 0;
  for (int dy = -reach; dy <= reach; dy += reach) {
    for (int dx = -reach; dx <= reach; dx += reach) {
      if (dx == 0 && dy == 0) continue;
      const std::size_t i = index(x + dx, y + dy);
      if (in.dark->hot[i] || frame.samples[i] >= sensor.usable_below_dn()) return;
      around[n++] = frame.samples[i];
    }
  }
  std::sort(around.begin(), around.end());
  HotPixel pixel;
  const double middle = 0.5 * (around[3] + around[4]);
  pixel.surround_dn = std::max(0.0, middle - sensor.black_level_dn);
  if (around[6] - around[1] > kSmoothSigmas * std::sqrt(sensor.variance_dn2(pixel.surround_dn))) return;
  pixel.contrast_dn = frame.samples[own] - middle;
  pixel.excess_dn = static_cast<double>(in.dark->mean_dn[own]) - in.dark->median_dn;
  pixel.dark_variance_dn2 = in.dark->variance_of_mean_dn2(own, sensor);
  pixels.push_back(pixel);
}

void gather(const DarkedFrame& in, const LinearSensor& sensor, std::vector<HotPixel>& pixels) {
  const MasterDark& dark = *in.dark;
  const double least_dn =
      kExcessSigmas * std::sqrt(std::max(dark.pixel_variance_dn2, 1.0 / 12.0) / static_cast<double>(dark.repetitions));
  for (int y = 0; y < dark.height_px; ++y) {
    for (int x = 0; x < dark.width_px; ++x) {
      const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(dark.width_px) + static_cast<std::size_t>(x);
      if (static_cast<double>(dark.mean_dn[i]) - dark.median_dn < least_dn) continue;
      // A saturated hot pixel, in the frame or in the dark, says only that it is hot. By the dark, not by the sample, as
      // far as can be: leaving out samples for being high would make the scale too low.
      if (dark.mean_dn[i] > 0.5 * (sensor.clip_dn + sensor.black_level_dn)) continue;
      if (in.frame->samples[i] >= sensor.usable_below_dn()) continue;
      consider(in, x, y, sensor, pixels);
    }
  }
}

double coarse_minimum(const std::vector<HotPixel>& pixels, double from, double to, double step) {
  double best = 1.0, least = entropy(pixels, 1.0, 2.0, 200.0);
  for (double scale = from; scale < to; scale *= step) {
    const double here = entropy(pixels, scale, 2.0, 200.0);
    if (here < least) {
      least = here;
      best = scale;
    }
  }
  return best;
}

double fine_minimum(const std::vector<HotPixel>& pixels, double about) {
  constexpr double kGolden = 0.6180339887498949;
  double low = about / 1.08, high = about * 1.08;
  double a = high - kGolden * (high - low), b = low + kGolden * (high - low);
  double at_a = entropy(pixels, a, 0.5, 40.0), at_b = entropy(pixels, b, 0.5, 40.0);
  while (high - low > 1e-5 * about) {
    if (at_a < at_b) {
      high = b;
      b = a;
      at_b = at_a;
      a = high - kGolden * (high - low);
      at_a = entropy(pixels, a, 0.5, 40.0);
    } else {
      low = a;
      a = b;
      at_a = at_b;
      b = low + kGolden * (high - low);
      at_b = entropy(pixels, b, 0.5, 40.0);
    }
  }
  return 0.5 * (low + high);
}

// Sandwich: the scores' variance over the curvature, with the density held as it was found. 0 if there is no minimum.
double sigma_of(const std::vector<HotPixel>& pixels, double scale) {
  const SmoothedDensity density(residuals(pixels, scale), 0.5, 40.0);
  double steepness = 0.0;
  for (const HotPixel& p : pixels) steepness += std::pow(p.excess_dn / p.sigma_dn, 2);
  const double step = 0.5 / std::sqrt(steepness / static_cast<double>(pixels.size()));
  const std::vector<double> below = residuals(pixels, scale - step), at = residuals(pixels, scale),
                            above = residuals(pixels, scale + step);
  double scores = 0.0, curvature = 0.0;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const double lower = -density.log_density(below[i]), here = -density.log_density(at[i]),
                 upper = -density.log_density(above[i]);
    scores += std::pow((upper - lower) / (2.0 * step), 2);
    curvature += (upper - 2.0 * here + lower) / (step * step);
  }
  return curvature > 0.0 ? std::sqrt(scores) / curvature : 0.0;
}

}  // namespace

DarkScale fit_dark_scale(const std::vector<DarkedFrame>& frames, const LinearSensor& sensor) {
  if (frames.empty()) throw BadInput("dark scale", "no frames", "at least one");
  std::vector<HotPixel> pixels;
  for (const DarkedFrame& in : frames) {
    if (in.frame->width_px != in.dark->width_px || in.frame->height_px != in.dark->height_px ||
        in.frame->samples.size() != in.dark->mean_dn.size()) {
      throw BadInput("dark scale", "a frame and a dark of different size", "frames and darks of one camera");
    }
    gather(in, sensor, pixels);
  }
  DarkScale found;
  found.pixels = static_cast<int>(pixels.size());
  if (found.pixels < kFewestDarkScalePixels) return found;
  double scale = 1.0;
  set_sigmas(pixels, scale, sensor);
  scale = coarse_minimum(pixels, kLeastScale, kMostScale, kCoarseStep);
  for (int pass = 0; pass < 3; ++pass) {  // the noise depends on the scale
    set_sigmas(pixels, scale, sensor);
    scale = fine_minimum(pixels, scale);
  }
  const double sigma = sigma_of(pixels, scale);
  if (!(sigma > 0.0) || sigma > kLeastRelativeAccuracy * scale) return found;
  found.determined = true;
  found.scale = scale;
  found.sigma = sigma;
  found.needed = std::abs(scale - 1.0) > kDarkScaleSigmas * sigma;
  return found;
}

MasterDark scaled_dark(const MasterDark& dark, const DarkScale& scale, const LinearSensor& sensor) {
  MasterDark scaled = dark;
  scaled.scale = scale.scale;
  scaled.scale_sigma = scale.sigma;
  const double typical_dn = std::max(0.0, dark.median_dn - sensor.black_level_dn);
  for (std::size_t i = 0; i < dark.mean_dn.size(); ++i) {
    const double excess_dn = static_cast<double>(dark.mean_dn[i]) - dark.median_dn;
    const double noise_dn2 = dark.variance_of_mean_dn2(i, sensor);
    const double own = excess_dn > 0.0 ? std::max(0.0, 1.0 - noise_dn2 / (excess_dn * excess_dn)) * excess_dn : 0.0;
    scaled.mean_dn[i] += static_cast<float>((scale.scale - 1.0) * (typical_dn + own));
  }
  scaled.median_dn += (scale.scale - 1.0) * typical_dn;
  return scaled;
}

}  // namespace lumitexel
