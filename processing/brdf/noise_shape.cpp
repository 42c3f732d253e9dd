#include "processing/brdf/noise_shape.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lumitexel {
namespace {

constexpr double kLeastOutliers = 1e-5, kLeastOutlierScale = 4.0;

double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

// ln(exp(a) + exp(b))
double log_sum(double a, double b) {
  const double most = std::max(a, b);
  return most + std::log1p(std::exp(std::min(a, b) - most));
}

// ln(g(z) sqrt(2 pi)) at z = 0
double log_height(const NoiseShape& shape) {
  const double p = shape.power;
  const double log_a = std::log(shape.width) + 0.5 * (log_gamma(1.0 / p) - log_gamma(3.0 / p));
  return std::log(p) - std::numbers::ln2 - log_a - log_gamma(1.0 / p) + 0.5 * std::log(2.0 * std::numbers::pi);
}

}  // namespace

WhitenedSquares whitened_squares(const ErrorModel& error, const Observation& sample, int channels, const ChannelValues& predicted) {
  const ScaledResiduals residuals = scaled_residuals(error, sample, channels, predicted);
  WhitenedSquares squares;
  for (Eigen::Index i = 0; i < channels; ++i) {
    const auto c = static_cast<std::size_t>(i);
    const double z = whitened(error, residuals, i);
    squares.square[c] = z * z;
    squares.variances *= residuals.scale[c] * residuals.scale[c];
  }
  return squares;
}

ShapedDeviance::ShapedDeviance(const ErrorModel& error, int channels, const NoiseShape& shape) : channels_(channels) {
  if (error.outlier_share <= 0.0 && error.freedom < ErrorModel::kGaussian) throw std::invalid_argument("noise shape: of errors with Student's tails");
  const double p = shape.power, share = std::max(error.outlier_share, kLeastOutliers);
  const double scale = error.outlier_share > 0.0 ? error.outlier_scale : kLeastOutlierScale;
  half_power_ = 0.5 * p;
  inverse_square_ = std::exp(log_gamma(3.0 / p) - log_gamma(1.0 / p)) / (shape.width * shape.width);
  narrow_log_ = std::log1p(-share) + channels * log_height(shape);
  wide_log_ = std::log(share) - channels * std::log(scale);
  wide_ = 1.0 / (scale * scale);
  constant_ = error.log_determinant();
}

double ShapedDeviance::of(const WhitenedSquares& sample) const {
  double powers = 0.0, squares = 0.0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(channels_); ++c) {
    squares += sample.square[c];
    powers += std::pow(sample.square[c] * inverse_square_, half_power_);
  }
  return std::log(sample.variances) + constant_ - 2.0 * log_sum(narrow_log_ - powers, wide_log_ - 0.5 * wide_ * squares);
}

double ShapedMisfit::of(std::span<const Observation> samples) const {
  double sum = 0.0;
  for (const Observation& sample : samples) {
    sum += deviance_.of(whitened_squares(error_, sample, brdf_.channels(), predicted_reflectance(brdf_, sample.geometry)));
  }
  return sum;
}

}  // namespace lumitexel
