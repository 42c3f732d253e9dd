// How abruptly a mixture's errors end. A normal distribution falls smoothly; noise that is uniform, as rounding is, ends at an edge, and
// a sample beyond the edge rules a material out that the normal distribution would only have called less likely. Whose a lumitexel is
// such an edge tells better; the BRDFs go on being fitted by the errors' variance, which stays efficient enough and has no cliffs.
//
// Whitened residuals z of variance one then follow, channel by channel, the generalised normal distribution (Subbotin 1923)
//   g(z) = p / (2 a Gamma(1/p)) exp(-|z / a|^p),   a = width * sqrt(Gamma(1/p) / Gamma(3/p)),
// p = 2 normal, p to infinity uniform; a share of outliers, at least kLeastOutliers, stays normal and wide (ErrorModel), so that no sample is
// beyond all reach.
#pragma once

#include <array>
#include <span>

#include "processing/brdf/error_model.h"
#include "processing/brdf/prepared_brdf.h"

namespace lumitexel {

struct NoiseShape {
  double power = 2.0;  // p, from 2
  double width = 1.0;  // over that of variance one: the scale was estimated with another distribution
  bool normal() const { return power == 2.0; }
};

// A sample's whitened residuals, squared, and the product of its channels' variances (SampleMisfit).
struct WhitenedSquares {
  std::array<double, kMaxChannels> square{};
  double variances = 1;
};
WhitenedSquares whitened_squares(const ErrorModel& error, const Observation& sample, int channels, const ChannelValues& predicted);

// Minus twice the log likelihood of samples with such errors, up to the constant of misfit.h. The error model has one normal distribution
// or two; std::invalid_argument for Student's t.
class ShapedDeviance {
 public:
  ShapedDeviance(const ErrorModel& error, int channels, const NoiseShape& shape);
  double of(const WhitenedSquares& sample) const;

 private:
  int channels_;
  double half_power_, inverse_square_;              // |z / a|^p as (z^2 / a^2)^(p / 2)
  double narrow_log_, wide_log_, wide_, constant_;  // logarithms of the two densities' factors; 1 / outlier_scale^2; the correlation's
};

// The same of a BRDF's samples. `error` must outlive it.
class ShapedMisfit {
 public:
  ShapedMisfit(const Brdf& brdf, const ErrorModel& error, const NoiseShape& shape)
      : brdf_(brdf), error_(error), deviance_(error, brdf.channels, shape) {}
  double of(std::span<const Observation> samples) const;

 private:
  PreparedBrdf brdf_;
  const ErrorModel& error_;
  ShapedDeviance deviance_;
};

}  // namespace lumitexel
