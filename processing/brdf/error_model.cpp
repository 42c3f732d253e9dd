#include "processing/brdf/error_model.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kLeastProduct = 1e-150;  // before a product is turned into its logarithm

// The two densities over exp(-squares / 2 outlier_scale^2), the wide one's fall, so that their sum does not underflow far out.
struct TwoNormals {
  double wide, narrow_share, wide_share;

  TwoNormals(const ErrorModel& error, int channels)
      : wide(1.0 / (error.outlier_scale * error.outlier_scale)), narrow_share(1.0 - error.outlier_share), wide_share(error.outlier_share) {
    for (int c = 0; c < channels; ++c) wide_share /= error.outlier_scale;
  }
  double falling(const SampleMisfit& misfit) const { return std::exp(-0.5 * misfit.squares * (1.0 - wide)); }
};

}  // namespace

void ErrorModel::set_correlation(const ChannelMatrix& correlation) {
  const Eigen::LLT<ChannelMatrix> factor(correlation);
  const ChannelMatrix lower = factor.matrixL();
  whitening_ = lower.triangularView<Eigen::Lower>().solve(ChannelMatrix::Identity(lower.rows(), lower.cols()));
  log_determinant_ = 2.0 * lower.diagonal().array().log().sum();
}

ErrorModel ErrorModel::paper(int channels, double intensity_weight) {
  ErrorModel error;
  error.relative = 0.0;
  error.floor = 1.0;
  error.freedom = kGaussian;
  // Precision w J + (1 - J) with J the projection onto equal channels; its inverse is J / w + (1 - J).
  const ChannelMatrix mean = ChannelMatrix::Constant(channels, channels, 1.0 / channels);
  error.set_correlation(ChannelMatrix::Identity(channels, channels) + (1.0 / intensity_weight - 1.0) * mean);
  return error;
}

ScaledResiduals scaled_residuals(const ErrorModel& error, const Observation& sample, int channels, const ChannelValues& predicted) {
  ScaledResiduals residuals;
  for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) {
    residuals.scale[c] = std::sqrt(error.variance(predicted[c], static_cast<double>(sample.variance[c])));
    residuals.over_scale[c] = (static_cast<double>(sample.reflectance[c]) - predicted[c]) / residuals.scale[c];
  }
  return residuals;
}

double whitened(const ErrorModel& error, const ScaledResiduals& residuals, Eigen::Index i) {
  const ChannelMatrix& whitening = error.whitening();
  if (whitening.size() == 0) return residuals.over_scale[static_cast<std::size_t>(i)];
  double value = 0.0;
  for (Eigen::Index j = 0; j <= i; ++j) value += whitening(i, j) * residuals.over_scale[static_cast<std::size_t>(j)];
  return value;
}

SampleMisfit sample_misfit(const ErrorModel& error, const ScaledResiduals& residuals, int channels) {
  SampleMisfit misfit;
  double scales = 1.0;
  for (Eigen::Index i = 0; i < channels; ++i) {
    scales *= residuals.scale[static_cast<std::size_t>(i)];
    const double value = whitened(error, residuals, i);
    misfit.squares += value * value;
  }
  misfit.variances = scales * scales;
  return misfit;
}

SampleMisfit sample_misfit(const ErrorModel& error, const Observation& sample, int channels, const ChannelValues& predicted) {
  return sample_misfit(error, scaled_residuals(error, sample, channels, predicted), channels);
}

double deviance(const ErrorModel& error, const SampleMisfit& misfit, int channels) {
  const double log_scale = std::log(misfit.variances) + error.log_determinant();
  if (error.outlier_share > 0.0) {
    const TwoNormals two(error, channels);
    return log_scale + misfit.squares * two.wide - 2.0 * std::log(two.narrow_share * two.falling(misfit) + two.wide_share);
  }
  if (error.freedom >= ErrorModel::kGaussian) return log_scale + misfit.squares;
  return log_scale + (error.freedom + channels) * std::log1p(misfit.squares / error.freedom);
}

// The normalisation of Student's t beyond that of the normal distribution.
double deviance_constant(const ErrorModel& error, int channels) {
  if (error.outlier_share > 0.0 || error.freedom >= ErrorModel::kGaussian) return 0.0;
  int sign = 0;
  const double upper = ::lgamma_r(0.5 * (error.freedom + channels), &sign), lower = ::lgamma_r(0.5 * error.freedom, &sign);
  return channels * std::log(0.5 * error.freedom) - 2.0 * (upper - lower);
}

void DevianceSum::add(const SampleMisfit& misfit) {
  ++samples_;
  variances_ *= misfit.variances;
  if (error_.outlier_share > 0.0) {
    const TwoNormals two(error_, channels_);
    squares_ += misfit.squares * two.wide;
    tails_ *= two.narrow_share * two.falling(misfit) + two.wide_share;
  } else if (error_.freedom >= ErrorModel::kGaussian) {
    squares_ += misfit.squares;
  } else {
    tails_ *= 1.0 + misfit.squares / error_.freedom;
  }
  const auto tame = [](double product) { return product > kLeastProduct && product < 1.0 / kLeastProduct; };
  if (tame(variances_) && tame(tails_)) return;
  logs_ = total() - squares_ - samples_ * error_.log_determinant();
  variances_ = tails_ = 1.0;
}

double DevianceSum::total() const {
  const double power = error_.outlier_share > 0.0 ? -2.0 : error_.freedom + channels_;
  const double tails = tails_ == 1.0 ? 0.0 : power * std::log(tails_);
  return squares_ + samples_ * error_.log_determinant() + logs_ + std::log(variances_) + tails;
}

double inlier_probability(const ErrorModel& error, const SampleMisfit& misfit, int channels) {
  if (error.outlier_share <= 0.0) return 1.0;
  const TwoNormals two(error, channels);
  const double narrow = two.narrow_share * two.falling(misfit);
  return narrow / (narrow + two.wide_share);
}

double weight_of_inlier(const ErrorModel& error, double probability) {
  return probability + (1.0 - probability) / (error.outlier_scale * error.outlier_scale);
}

double robust_weight(const ErrorModel& error, const SampleMisfit& misfit, int channels) {
  if (error.outlier_share > 0.0) return weight_of_inlier(error, inlier_probability(error, misfit, channels));
  if (error.freedom >= ErrorModel::kGaussian) return 1.0;
  return (error.freedom + channels) / (error.freedom + misfit.squares);
}

}  // namespace lumitexel
