#include "processing/evaluation/image_error.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kPeakFraction = 0.999;

template <typename PerValue>
void for_each_value(const Image& image, const std::vector<std::uint8_t>& counted, const PerValue& per_value) {
  const auto channels = static_cast<std::size_t>(image.channels);
  for (std::size_t pixel = 0; pixel < counted.size(); ++pixel) {
    if (counted[pixel] == 0) continue;
    for (std::size_t c = 0; c < channels; ++c) per_value(pixel * channels + c);
  }
}

}  // namespace

void ErrorSums::Ratio::add(double p, double q) {
  error += (p - q) * (p - q);
  photograph += q * q;
}

void ErrorSums::Ratio::add(const Ratio& other) {
  error += other.error;
  photograph += other.photograph;
}

double ErrorSums::Ratio::value() const { return std::sqrt(error / photograph); }

void ErrorSums::add(const Image& prediction, const Image& photograph, const std::vector<std::uint8_t>& counted) {
  const double peak = percentile(photograph, counted, kPeakFraction);
  for_each_value(photograph, counted, [&](std::size_t i) {
    const double p = prediction.data[i], q = photograph.data[i];
    linear_.add(p, q);
    clipped_.add(std::min(p, peak), std::min(q, peak));
    square_root_.add(std::sqrt(std::max(p, 0.0)), std::sqrt(std::max(q, 0.0)));
    if (peak <= 0.0) return;  // a black photograph has no peak to compare with
    error_over_peak_ += (p - q) * (p - q) / (peak * peak);
    ++values_;
  });
}

void ErrorSums::add(const ErrorSums& other) {
  linear_.add(other.linear_);
  clipped_.add(other.clipped_);
  square_root_.add(other.square_root_);
  error_over_peak_ += other.error_over_peak_;
  values_ += other.values_;
}

ImageError ErrorSums::error() const {
  return {linear_.value(), clipped_.value(), square_root_.value(),
          -10.0 * std::log10(error_over_peak_ / static_cast<double>(values_))};
}

double percentile(const Image& image, const std::vector<std::uint8_t>& counted, double fraction) {
  std::vector<float> values;
  for_each_value(image, counted, [&](std::size_t i) { values.push_back(image.data[i]); });
  if (values.empty()) return 0.0;
  const auto count = static_cast<double>(values.size());
  const auto rank = static_cast<std::size_t>(std::clamp(std::ceil(fraction * count) - 1.0, 0.0, count - 1.0));
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(rank);
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace lumitexel
