// The normal equations of views with a pose each and unknowns that all share, and how far given poses are off on the whole.
#pragma once

#include <vector>

#include "processing/calibration/pose/centred_pose.h"

namespace lumitexel {

// One sigma of given poses' errors about zero, in the camera's axes.
struct PoseSpread {
  double turn_rad = 0, across_m = 0, along_m = 0;
  PoseStep information() const;  // its diagonal, of a PoseStep
};

// J^T W J and J^T W r of a step of every view's pose and of the shared unknowns: only views' blocks with themselves and with
// the shared ones are not zero. What is known beforehand of the shared unknowns is in it.
struct PosedViewSystem {
  std::vector<PoseCovariance> own;
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> mixed;
  std::vector<PoseStep> score;
  Eigen::MatrixXd shared;
  Eigen::VectorXd shared_score;
  PosedViewSystem(std::size_t views, Eigen::Index shared_unknowns);
};

struct PosedViewSolution {
  std::vector<PoseStep> steps;               // to be taken from where the system was made
  Eigen::VectorXd shared_step;
  std::vector<PoseCovariance> covariance;    // (information)^-1, each view's block
};

// from_given: the steps that lead from the given poses to where the system was made. By elimination of the views; the time goes with
// their number.
PosedViewSolution solve(const PosedViewSystem& system, const PoseSpread& spread, const std::vector<PoseStep>& from_given);

// The spread of greatest marginal likelihood for the system as it is, by `rounds` of expectation and maximisation from a start.
// Views without equations do not count.
PoseSpread likeliest_spread(const PosedViewSystem& system, PoseSpread start, const std::vector<PoseStep>& from_given, int rounds);
// One sigma (of its squares) more than that: what the views cannot exclude, as an estimate of zero does not mean that it is.
PoseSpread upper_spread(const PosedViewSystem& system, const PoseSpread& spread);

}  // namespace lumitexel
