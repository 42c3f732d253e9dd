// A small patch of a picture fitted by a model of what is seen there: the engine of the corner finders.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "processing/image/hdr_merge.h"

namespace lumitexel {

struct PatchSample {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();  // centre of the pixel
  double value = 0, sigma = 0;                      // sigma 0: unknown (imported photographs)
  int part = 0;                                     // free for the model: which edge the sample belongs to
};

// The usable samples of green (mono: all) whose centres lie within the rectangle. Green alone, because lenses bend
// colours differently and green has half of all pixels. Left out: saturated, defective, not finite.
std::vector<PatchSample> patch_samples(const MosaicRadiance& image, const Eigen::Vector2d& least,
                                       const Eigen::Vector2d& most);

// The value that `parameters` predict for a sample; its derivatives go into `gradient` (as long as the parameters).
using PatchModel =
    std::function<double(const PatchSample&, const Eigen::VectorXd& parameters, Eigen::VectorXd& gradient)>;

struct PatchFit {
  Eigen::VectorXd parameters;
  // (J^T W J)^-1, times the reduced chi square where that is above 1 (the model is then not the whole truth) or where
  // no sigmas were given.
  Eigen::MatrixXd covariance;
  double reduced_chi2 = 0;
};

// Weighted least squares by Levenberg and Marquardt. None if there are not more samples than parameters, or it does not
// converge, or the samples do not determine the parameters.
std::optional<PatchFit> fit_patch(const std::vector<PatchSample>& samples, const Eigen::VectorXd& start,
                                  const PatchModel& model);

// The integral of the unit normal density up to x, and the density.
double normal_integral(double x);
double normal_density(double x);

}  // namespace lumitexel
