// How much contour distances of neighbouring places have in common, and what that does to a fit's covariance.
//
// Where the mesh is off the object (relief that a scan does not show), the distances of a whole neighbourhood are off
// together, in all views that show it, so a thousand points say no more than some dozens of independent ones. The distances' covariance
// C(d) as a function of the distance d between their surface points is estimated from the residuals themselves, up to
// its first zero, and the fit's covariance is
//   H^-1 (sum_ij w_i w_j J_i^T J_j C(d_ij)) H^-1,   H = sum_i w_i J_i^T J_i,
// scaled for the parameters that the residuals have already followed. Never below the one of independent residuals.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace lumitexel {

// What the measured contour and the computed outline may have in common all around, and no residual shows: the errors of
// poses of exact meshes, without noise, are of this size (tests/bench/pose_accuracy.cpp). It enters every covariance as
// floor^2 (sum_i w_i J_i^T J_i / sum_i w_i)^-1, as if there were but one point.
inline constexpr double kSharedError_px = 0.015;

struct WeightedResiduals {
  std::vector<Eigen::Vector3d> x_in_mesh;
  Eigen::VectorXd residual, weight;
  Eigen::MatrixXd jacobian;  // one row each
};

struct FitCovariance {
  Eigen::MatrixXd meat;      // sum_ij w_i w_j J_i^T J_j C(d_ij), scaled
  double sigma = 0;          // of one residual
  double independent = 0;    // as many independent residuals say as much
};

// reach_m: residuals farther apart than this are taken as independent.
FitCovariance correlated_scores(const WeightedResiduals& fit, double reach_m);

// H^-1 M H^-1; directions that H does not determine come out with a very large, finite variance.
Eigen::MatrixXd sandwich(const Eigen::MatrixXd& information, const Eigen::MatrixXd& meat);

}  // namespace lumitexel
