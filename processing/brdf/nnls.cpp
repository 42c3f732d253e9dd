#include "processing/brdf/nnls.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

namespace lumitexel {
namespace {

// A basis that is nearly dark in all samples (1e-9 of the brightest one) would need a weight without bound to explain anything.
constexpr double kNoInformation = 1e-18;

// Unconstrained optimum over the free unknowns; the others are zero.
BasisVector solve_free(const BasisMatrix& matrix, const BasisVector& right, unsigned free) {
  const Eigen::Index n = right.size();
  BasisMatrix reduced = matrix;
  BasisVector target = right;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (free >> i & 1u) continue;
    reduced.row(i).setZero();
    reduced.col(i).setZero();
    reduced(i, i) = 1.0;
    target[i] = 0.0;
  }
  return reduced.ldlt().solve(target);
}

// The held unknown whose growth lowers the cost fastest; -1 if none does.
int steepest_held(const BasisMatrix& matrix, const BasisVector& right, const NnlsSolution& solution) {
  const BasisVector gain = right - matrix * solution.weights;
  const double largest = matrix.diagonal().maxCoeff();
  int best = -1;
  double best_gain = 0.0;
  for (int i = 0; i < static_cast<int>(right.size()); ++i) {
    if (solution.free >> i & 1u || !(matrix(i, i) > kNoInformation * largest)) continue;
    // Scaled by the unknown's own curvature, so that the unit of a basis does not matter.
    const double scaled = gain[i] / std::sqrt(matrix(i, i));
    const double noise = 1e-12 * std::abs(right[i]) / std::sqrt(matrix(i, i));
    if (scaled > best_gain + noise) {
      best_gain = scaled;
      best = i;
    }
  }
  return best;
}

}  // namespace

NnlsSolution solve_nnls(const BasisMatrix& matrix, const BasisVector& right) {
  const int n = static_cast<int>(right.size());
  NnlsSolution solution;
  solution.weights = BasisVector::Zero(n);
  for (int round = 0; round < 4 * n; ++round) {
    const int entering = steepest_held(matrix, right, solution);
    if (entering < 0) return solution;
    solution.free |= 1u << entering;
    for (int inner = 0; inner <= n; ++inner) {
      const BasisVector target = solve_free(matrix, right, solution.free);
      double step = 1.0;
      int leaving = -1;
      for (int i = 0; i < n; ++i) {
        if (!(solution.free >> i & 1u) || target[i] > 0.0) continue;
        const double reach = solution.weights[i] / (solution.weights[i] - target[i]);
        if (leaving < 0 || reach < step) {
          step = std::isfinite(reach) ? reach : 0.0;
          leaving = i;
        }
      }
      if (leaving < 0) {
        solution.weights = target;
        break;
      }
      solution.weights += step * (target - solution.weights);
      solution.weights = solution.weights.cwiseMax(0.0);
      solution.weights[leaving] = 0.0;
      solution.free &= ~(1u << leaving);
    }
  }
  solution.converged = false;
  return solution;
}

}  // namespace lumitexel
