// Non-negative least squares on normal equations, for the few unknowns of one texel's weights.
#pragma once

#include <Eigen/Core>

namespace lumitexel {

inline constexpr int kMaxBasis = 8;
using BasisMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxBasis, kMaxBasis>;
using BasisVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxBasis, 1>;

struct NnlsSolution {
  BasisVector weights;   // >= 0
  unsigned free = 0;     // bit i: weight i is not held at zero
  bool converged = true; // false only if the active set kept cycling; the weights are then feasible but not optimal
  bool rank_deficient = false;  // other weights would serve as well; of all that do, these have the least norm
};

// Minimises x^T matrix x / 2 - right^T x over x >= 0 (Lawson and Hanson's active set). `matrix` must be symmetric
// positive semidefinite; an unknown without information stays at zero, and those that nothing tells apart share alike.
NnlsSolution solve_nnls(const BasisMatrix& matrix, const BasisVector& right);

}  // namespace lumitexel
