#include "processing/image/merge_pixel.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "processing/image/censored_normal.h"
#include "processing/image/radiance_image.h"

namespace lumitexel {
namespace {

constexpr double kDarkSigmas = 3.0;
// A censored sample that was expected so far above the bound tells nothing new.
constexpr double kCertainSigmas = 5.0;
constexpr int kMostNewtonSteps = 20;

}  // namespace

PixelMerger::PixelMerger(std::vector<BracketExposure> ascending, int bits, const LinearSensor& sensor,
                         const ResponseCurve* response)
    : exposures_(std::move(ascending)), sensor_(sensor), response_(response), per_electron_(1.0 / sensor.electrons_per_dn) {
  if (response) table_ = response->table(bits);
  for (const BracketExposure& e : exposures_) {
    noise_.push_back({sensor.variance_dn2(0.0) + e.dark->pixel_variance_dn2 * e.dark->scale * e.dark->scale / e.dark->repetitions,
                      per_electron_ * e.dark->scale / e.dark->repetitions, e.time_s});
  }
  const double bound = std::ceil(sensor.usable_below_dn());
  bound_ = bound > 0.0 ? static_cast<std::uint32_t>(bound) : 0;
  bound_linear_ = response ? response->linear_dn(bound - 0.5) : bound - 0.5;
}

template <bool kCurved>
double PixelMerger::linear(double code) const {
  if constexpr (kCurved) return response_->linear_dn(code);
  return code;
}

template <bool kCurved>
double PixelMerger::signal(std::size_t k, std::size_t i) const {
  const BracketExposure& e = exposures_[k];
  if constexpr (kCurved) return table_[e.samples[i]] - response_->linear_dn(static_cast<double>(e.dark->mean_dn[i]));
  return static_cast<double>(e.samples[i]) - static_cast<double>(e.dark->mean_dn[i]);
}

// Of signal(k, i) where its expectation is signal_dn.
template <bool kCurved>
double PixelMerger::variance(std::size_t k, std::size_t i, double signal_dn) const {
  const MasterDark& dark = *exposures_[k].dark;
  const double dark_dn = static_cast<double>(dark.mean_dn[i]);
  const double current_dn = std::max(0.0, linear<kCurved>(dark_dn) - linear<kCurved>(sensor_.black_level_dn));
  const double shot = (std::max(signal_dn, 0.0) + current_dn) * per_electron_;
  double fixed = noise_[k].fixed_dn2 + noise_[k].excess_weight * std::max(0.0, dark_dn - dark.median_dn);
  if (dark.scale_sigma > 0.0) {
    const double own = dark.scale_sigma / dark.scale * (dark_dn - sensor_.black_level_dn);
    fixed += own * own;
  }
  if constexpr (kCurved) {
    const double slope = response_->slope_at(std::max(signal_dn, 0.0) + current_dn + linear<true>(sensor_.black_level_dn));
    fixed *= slope * slope;
  }
  return shot + fixed;
}

template <bool kCurved>
PixelEstimate PixelMerger::unusable(std::size_t i) const {
  const bool clipped = std::none_of(exposures_.begin(), exposures_.end(),
                                    [&](const BracketExposure& e) { return e.samples[i] < bound_; });
  const double time_s = exposures_[0].time_s, signal_dn = signal<kCurved>(0, i);
  return {signal_dn / time_s, variance<kCurved>(0, i, signal_dn) / (time_s * time_s),
          clipped ? kPixelSaturated : kPixelDefective};
}

// The maximum of the likelihood where some exposures are known only to lie above the bound: `estimate` and its weight
// (1 / variance) stand for all others. Newton's method on a concave function.
template <bool kCurved>
void PixelMerger::add_censored(std::size_t first, std::size_t i, double weight, PixelEstimate& estimate) const {
  double rate = estimate.rate, curvature = weight;
  for (int step = 0; step < kMostNewtonSteps; ++step) {
    double slope = weight * (estimate.rate - rate);
    curvature = weight;
    for (std::size_t k = first; k < exposures_.size(); ++k) {
      if (exposures_[k].samples[i] < bound_ || exposures_[k].dark->hot[i]) continue;
      const double time_s = exposures_[k].time_s;
      const double bound_dn = bound_linear_ - linear<kCurved>(static_cast<double>(exposures_[k].dark->mean_dn[i]));
      const double sigma = std::sqrt(variance<kCurved>(k, i, bound_dn));
      const double a = (rate * time_s - bound_dn) / sigma, h = log_cdf_slope(a);
      slope += time_s / sigma * h;
      curvature += time_s * time_s / (sigma * sigma) * h * (h + a);
      if (a > kCertainSigmas) break;  // longer ones are more certain still
    }
    const double move = slope / curvature;
    rate += move;
    if (std::abs(move) * std::sqrt(curvature) < 1e-4) break;
  }
  estimate.rate = rate;
  estimate.variance = 1.0 / curvature;
}

template <bool kCurved>
PixelEstimate PixelMerger::merge_as(std::size_t i) const {
  constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
  double counts = 0.0, time_s = 0.0;
  std::size_t longest = kNone, first_censored = kNone;
  bool all_zero = true;
  for (std::size_t k = 0; k < exposures_.size(); ++k) {
    const BracketExposure& e = exposures_[k];
    if (e.dark->hot[i]) continue;
    if (e.samples[i] >= bound_) {
      first_censored = std::min(first_censored, k);
      continue;
    }
    counts += signal<kCurved>(k, i);
    time_s += e.time_s;
    all_zero = all_zero && e.samples[i] == 0;
    longest = k;
  }
  if (longest == kNone) return unusable<kCurved>(i);
  const double first_estimate = counts / time_s;
  double weighted = 0.0, weight = 0.0;
  for (std::size_t k = 0; k <= longest; ++k) {
    const BracketExposure& e = exposures_[k];
    if (e.dark->hot[i] || e.samples[i] >= bound_) continue;
    const double per_variance = e.time_s / variance<kCurved>(k, i, first_estimate * e.time_s);
    weighted += per_variance * signal<kCurved>(k, i);
    weight += per_variance * e.time_s;
  }
  PixelEstimate estimate{weighted / weight, 1.0 / weight, 0};
  if (first_censored != kNone) {
    const double censored_s = exposures_[first_censored].time_s;
    const double over_dn = estimate.rate * censored_s - bound_linear_ +
                           linear<kCurved>(static_cast<double>(exposures_[first_censored].dark->mean_dn[i]));
    const double spread_dn2 = variance<kCurved>(first_censored, i, estimate.rate * censored_s) +
                              estimate.variance * censored_s * censored_s;
    if (over_dn < kCertainSigmas * std::sqrt(spread_dn2)) add_censored<kCurved>(first_censored, i, weight, estimate);
  }
  const double darkness_dn = kDarkSigmas * std::sqrt(variance<kCurved>(longest, i, 0.0));
  if (all_zero || estimate.rate * exposures_[longest].time_s < darkness_dn) estimate.flags |= kPixelDark;
  return estimate;
}

template PixelEstimate PixelMerger::merge_as<true>(std::size_t) const;
template PixelEstimate PixelMerger::merge_as<false>(std::size_t) const;

}  // namespace lumitexel
