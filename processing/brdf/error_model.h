// How far a measured reflectance may lie from a predicted one: the photograph's noise, plus what the model cannot know
// (the coarse mesh's normals, misregistration, light between surfaces), which grows with the signal.
//
// The residuals of one sample's channels together follow Student's t with `freedom` degrees: scale of channel c
// sqrt((relative * predicted)^2 + floor^2 + measured variance), and one matrix for how the channels go together. Its tails are heavy,
// so one missed shadow does not decide, yet never flat, so that even samples that no BRDF explains still know which one is nearer.
// Or, where most samples err as a Gaussian has it and a few by far more, two normal distributions (Tukey 1960): a share `outlier_share` of
// the samples has a scale `outlier_scale` times as wide. The fit then keeps the efficiency of the others, of which Student's t gives up a
// part.
#pragma once

#include <Eigen/Core>
#include <span>

#include "processing/brdf/observations.h"

namespace lumitexel {

using ChannelMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxChannels, kMaxChannels>;

struct ErrorModel {
  static constexpr double kGaussian = 1e9;  // degrees of freedom from which the normal distribution serves

  ErrorModel() = default;
  ErrorModel(double relative_scale, double floor_scale) : relative(relative_scale), floor(floor_scale) {}

  double relative = 0.3;  // scale as a fraction of the predicted reflectance
  double floor = 1e-3;    // scale for a prediction of zero, 1/sr
  double freedom = 4.0;
  double outlier_share = 0.0;  // above zero: two normal distributions, whatever `freedom` says
  double outlier_scale = 1.0;  // at least 1
  // How many of a lumitexel's samples err independently, as a share: 1 all, 1/m for m samples that err as one. Only
  // criteria that weigh evidence ask for it.
  double independence = 1.0;

  double variance(double predicted, double measured_variance) const {
    const double share = relative * predicted;
    return share * share + floor * floor + measured_variance;
  }

  // Channels that err independently until this is called. `correlation` must be positive definite; its diagonal need not be one.
  void set_correlation(const ChannelMatrix& correlation);
  // L^-1 of correlation = L L^T: residuals over their scales become independent. Empty: the identity.
  const ChannelMatrix& whitening() const { return whitening_; }
  double log_determinant() const { return log_determinant_; }

  // Equation 6 of the paper as an error model: absolute residuals, squared, the same everywhere but for the
  // photograph's own variance, which is small beside one; intensity (the channels' mean)
  // counts `intensity_weight` times as much as colour.
  static ErrorModel paper(int channels, double intensity_weight);

 private:
  ChannelMatrix whitening_;
  double log_determinant_ = 0;
};

// One sample against a prediction of r (not f) per channel.
struct SampleMisfit {
  double squares = 0;   // r^T Sigma^-1 r
  double variances = 1; // product over the channels: det Sigma but for the correlation's own
};
// Residuals per channel over their scales, before whitening.
struct ScaledResiduals {
  std::array<double, kMaxChannels> over_scale{}, scale{};
};
ScaledResiduals scaled_residuals(const ErrorModel& error, const Observation& sample, int channels, const ChannelValues& predicted);
double whitened(const ErrorModel& error, const ScaledResiduals& residuals, Eigen::Index i);  // the i-th of the independent ones
SampleMisfit sample_misfit(const ErrorModel& error, const ScaledResiduals& residuals, int channels);
SampleMisfit sample_misfit(const ErrorModel& error, const Observation& sample, int channels, const ChannelValues& predicted);

// Minus twice the log likelihood of the sample, less deviance_constant, which is the same for all samples.
double deviance(const ErrorModel& error, const SampleMisfit& misfit, int channels);
double deviance_constant(const ErrorModel& error, int channels);
// Sums deviances, with one logarithm for many samples.
class DevianceSum {
 public:
  DevianceSum(const ErrorModel& error, int channels) : error_(error), channels_(channels) {}
  void add(const SampleMisfit& misfit);
  double total() const;

 private:
  const ErrorModel& error_;
  int channels_, samples_ = 0;
  double squares_ = 0, logs_ = 0;
  double variances_ = 1, tails_ = 1;  // products
};

// Probability that the sample is of the narrow one of the two normal distributions; 1 if there is only one.
double inlier_probability(const ErrorModel& error, const SampleMisfit& misfit, int channels);
double weight_of_inlier(const ErrorModel& error, double probability);  // p + (1 - p) / outlier_scale^2
// The factor by which such a sample counts less than a Gaussian would have it: for Student's t (nu + C) / (nu + squares), for two
// normal distributions the weight above.
double robust_weight(const ErrorModel& error, const SampleMisfit& misfit, int channels);

}  // namespace lumitexel
