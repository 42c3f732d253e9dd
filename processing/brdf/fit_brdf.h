// Fits a BRDF to samples by Levenberg-Marquardt (section 6 of the paper), from a start, with covariance.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "processing/brdf/brdf_parameters.h"
#include "processing/brdf/error_model.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

struct BrdfFitOptions {
  bool shared_shape = true;        // one lobe shape for all channels; the paper fits each channel apart
  std::vector<LobeBounds> bounds;  // one entry a lobe of the start; shorter: usual_bounds for the rest
  ErrorModel error;
  bool robust = true;              // outlying samples count less, as the error model's tails have it
  int reweightings = 3;            // 1: weights of the start alone, as for an error model that does not depend on the model
  int max_iterations = 30;         // steps of Levenberg-Marquardt, for each weighting
  bool brdf_alone = false;         // true: no misfit, chi_squared or covariance, which take as long as a step
};

struct BrdfFit {
  Brdf brdf;
  Eigen::MatrixXd covariance;   // of BrdfParameters, scaled by the residuals' own variance; zero rows for parameters at a bound
  double misfit = 0;            // minus twice the log likelihood, summed over samples by their shares
  double chi_squared = 0;       // weighted mean of squared whitened residuals, per sample and channel
  int iterations = 0;
  bool converged = false;
  bool rank_deficient = false;  // some parameters are not determined by the samples; they kept their start (minimum norm step)
};

// The parameters that such a fit of `start` has.
BrdfParameters parameters_of(const Brdf& start, const BrdfFitOptions& options);

// start: says how many lobes, of which family. Residuals are weighted by the error model at the model itself, reweighted
// as it changes, so that the estimate is unbiased where weighting by the measured value is not; outlying samples count less, as
// Student's t has it. Samples whose numbers are not finite must have been kept out. No samples: the start, rank deficient.
// Parallel; the same bits for any number of threads.
BrdfFit fit_brdf(const Brdf& start, FitSamples samples, const BrdfFitOptions& options);

// The covariance of BrdfParameters where only lumitexels err independently, not the samples of one, and where the error model need not be
// right: H^-1 S H^-1, H the normal matrix, less by what robust weights change with a residual, and S the scatter of the lumitexels' own gradients (Huber's sandwich, in Liang and Zeger's grouping of 1986).
// brdf: fitted to these samples so. Zero rows as in BrdfFit; all zero without two lumitexels.
Eigen::MatrixXd covariance_by_lumitexel(const Brdf& brdf, FitSamples samples, const BrdfFitOptions& options);

}  // namespace lumitexel
