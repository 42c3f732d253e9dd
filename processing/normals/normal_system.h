// The linear equations of all normals' steps in their tangent planes, two unknowns a lumitexel, weights following.
#pragma once

#include "processing/normals/surface_loops.h"

namespace lumitexel {

using Steps = std::vector<Eigen::Vector2d>;  // of each normal, radians, in its tangent frame

struct LinearSystem {
  double curl_weight = 0;
  std::vector<Eigen::Matrix2d> diagonal;  // all of a lumitexel's own terms but its loops', which are in `own` alone
  Steps right;
  std::vector<double> link;           // weight of each neighbour relation, as Neighbours::other
  std::vector<TangentFrame> frame;
  std::vector<Eigen::Matrix2d> data;  // what the samples alone say
  Steps right_alone;                  // of the samples and of the coarse mesh's normal, without neighbours and loops
  std::vector<Eigen::Matrix2d> own;   // diagonal with the loops: for preconditioning
};

// About `field`: with E what smooth_normals.h minimises, E(step) = E(0) - 2 right^T step + step^T matrix step.
LinearSystem linearise(const NormalProblem& problem, const Loops& loops, const NormalField& field, const NormalPrior& prior);

// Marquardt's: every lumitexel's own block grows by its share of its diagonal.
void damp(const std::vector<double>& share, LinearSystem& system);

// Conjugate gradients, preconditioned by each lumitexel's own block.
Steps solve(const NormalProblem& problem, const Loops& loops, const LinearSystem& system);

// The cost of an edge between neighbours over Student's t, of (difference / sigma)^2.
double edge_cost(double squares);

}  // namespace lumitexel
