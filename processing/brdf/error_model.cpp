#include "processing/brdf/error_model.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace lumitexel {
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

SampleMisfit sample_misfit(const ErrorModel& error, const Observation& sample, int channels, const ChannelValues& predicted) {
  SampleMisfit misfit;
  std::array<double, kMaxChannels> scaled{};
  double variances = 1.0;
  for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) {
    const double variance = error.variance(predicted[c], static_cast<double>(sample.variance[c]));
    variances *= variance;
    scaled[c] = (static_cast<double>(sample.reflectance[c]) - predicted[c]) / std::sqrt(variance);
  }
  const ChannelMatrix& whitening = error.whitening();
  for (Eigen::Index i = 0; i < channels; ++i) {
    double value = scaled[static_cast<std::size_t>(i)];
    if (whitening.size() > 0) {
      value = 0.0;
      for (Eigen::Index j = 0; j <= i; ++j) value += whitening(i, j) * scaled[static_cast<std::size_t>(j)];
    }
    misfit.squares += value * value;
  }
  misfit.log_scale = std::log(variances) + error.log_determinant();
  return misfit;
}

double deviance(const ErrorModel& error, const SampleMisfit& misfit, int channels) {
  if (error.freedom >= ErrorModel::kGaussian) return misfit.log_scale + misfit.squares;
  return misfit.log_scale + (error.freedom + channels) * std::log1p(misfit.squares / error.freedom);
}

// The normalisation of Student's t beyond that of the normal distribution.
double deviance_constant(const ErrorModel& error, int channels) {
  if (error.freedom >= ErrorModel::kGaussian) return 0.0;
  int sign = 0;
  const double upper = ::lgamma_r(0.5 * (error.freedom + channels), &sign), lower = ::lgamma_r(0.5 * error.freedom, &sign);
  return channels * std::log(0.5 * error.freedom) - 2.0 * (upper - lower);
}

double robust_weight(const ErrorModel& error, const SampleMisfit& misfit, int channels) {
  if (error.freedom >= ErrorModel::kGaussian) return 1.0;
  return (error.freedom + channels) / (error.freedom + misfit.squares);
}

}  // namespace lumitexel
