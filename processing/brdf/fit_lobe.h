// Fits the one-lobe isotropic Lafortune model (section 6 of the paper) to samples by Levenberg-Marquardt, with covariance.
// The lobe is a forward one, near the mirror direction, and enters only if the samples ask for it.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "processing/brdf/error_model.h"
#include "processing/brdf/lafortune.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

// The parameters of a fit as one vector: kd per channel, ln A per channel, then phi and ln N, once if the lobe has the
// same shape in all channels, else once a channel.
struct LobeParameters {
  int channels = 3;
  bool shared_shape = true;
  Eigen::VectorXd values;

  int diffuse(int c) const { return c; }
  int log_peak(int c) const { return channels + c; }
  int phi(int c) const { return 2 * channels + (shared_shape ? 0 : 2 * c); }
  int log_exponent(int c) const { return phi(c) + 1; }
  int size() const { return 2 * channels + (shared_shape ? 2 : 2 * channels); }

  static LobeParameters from(const LafortuneBrdf& brdf, bool shared_shape);
  LafortuneBrdf brdf() const;  // clamped into the range of validity
};

struct LobeFitOptions {
  bool shared_shape = true;  // one lobe shape for all channels; the paper fits each channel apart
  ErrorModel error;
  int max_iterations = 30;   // of Levenberg-Marquardt, for each of kReweightings weightings
};

struct LobeFit {
  LafortuneBrdf brdf;
  Eigen::MatrixXd covariance;  // of LobeParameters, scaled by the residuals' own variance; zero rows for parameters at a bound
  double cost = 0;             // mean over samples and channels of squared residual over variance
  int iterations = 0;
  bool converged = false;
  bool has_lobe = true;        // false: the samples ask for diffuse light alone, and brdf's lobe is off
  bool rank_deficient = false; // some parameters are not determined by the samples; they kept their start
};

// samples: pointers, so that a cluster's members need not be copied. `start` (if not null) is tried beside starts of
// our own. Residuals are weighted by 1 / error.variance(model), reweighted as the model changes, so that the estimate is
// unbiased where weighting by 1 / measured is not. An empty span gives a black BRDF, rank deficient.
LobeFit fit_one_lobe(std::span<const Observation* const> samples, int channels, const LafortuneBrdf* start,
                     const LobeFitOptions& options);

}  // namespace lumitexel
