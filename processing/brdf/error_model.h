// How far a measured reflectance may lie from a predicted one: the photograph's noise, plus what the model cannot know
// (the coarse mesh's normals, misregistration, light between surfaces), which grows with the signal.
//
// The residuals of one sample's channels together follow Student's t with `freedom` degrees: scale of channel c
// sqrt((relative * predicted)^2 + floor^2 + measured variance), and one matrix for how the channels go together. Its tails are heavy,
// so one missed shadow does not decide, yet never flat, so that even samples that no BRDF explains still know which one is nearer.
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
  double log_scale = 0; // ln det Sigma
};
SampleMisfit sample_misfit(const ErrorModel& error, const Observation& sample, int channels, const ChannelValues& predicted);

// Minus twice the log likelihood of the sample, less deviance_constant, which is the same for all samples.
double deviance(const ErrorModel& error, const SampleMisfit& misfit, int channels);
double deviance_constant(const ErrorModel& error, int channels);
// The factor by which Student's t counts such a sample less than a Gaussian would: (nu + C) / (nu + squares).
double robust_weight(const ErrorModel& error, const SampleMisfit& misfit, int channels);

}  // namespace lumitexel
