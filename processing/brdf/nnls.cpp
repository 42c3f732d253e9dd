#include "processing/brdf/nnls.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

namespace lumitexel {
namespace {

// A basis that is nearly dark in all samples (1e-9 of the brightest one) would need a weight without bound to explain anything.
constexpr double kNoInformation = 1e-18;
// Share of the diagonal at which a pivot is rounding; how far a ridge stays below the largest curvature.
constexpr double kRankTolerance = 1e-13, kRidge = 1e-9;

struct FreeSystem {
  BasisMatrix matrix;
  BasisVector right;
};

// The equations of the free unknowns; a held one has `diagonal` for its curvature and nothing else.
FreeSystem free_system(const BasisMatrix& matrix, const BasisVector& right, unsigned free, double diagonal) {
  FreeSystem reduced{matrix, right};
  for (Eigen::Index i = 0; i < right.size(); ++i) {
    if (free >> i & 1u) continue;
    reduced.matrix.row(i).setZero();
    reduced.matrix.col(i).setZero();
    reduced.matrix(i, i) = diagonal;
    reduced.right[i] = 0.0;
  }
  return reduced;
}

// Unconstrained optimum over the free unknowns; the others are zero.
BasisVector solve_free(const BasisMatrix& matrix, const BasisVector& right, unsigned free) {
  const FreeSystem reduced = free_system(matrix, right, free, 1.0);
  return reduced.matrix.ldlt().solve(reduced.right);
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

NnlsSolution active_set(const BasisMatrix& matrix, const BasisVector& right) {
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

// Whether the matrix, scaled to a unit diagonal, has a direction of no curvature.
bool lacks_rank(const BasisMatrix& matrix) {
  const Eigen::Index n = matrix.rows();
  BasisVector scale(n);
  for (Eigen::Index i = 0; i < n; ++i) {
    if (!(matrix(i, i) > 0.0)) return true;
    scale[i] = 1.0 / std::sqrt(matrix(i, i));
  }
  const BasisMatrix scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  return scaled.ldlt().vectorD().minCoeff() <= kRankTolerance * static_cast<double>(n);
}

// Unconstrained optimum of least norm over the free unknowns.
BasisVector least_norm_free(const BasisMatrix& matrix, const BasisVector& right, unsigned free) {
  const Eigen::Index n = right.size();
  const FreeSystem reduced = free_system(matrix, right, free, 0.0);
  const Eigen::SelfAdjointEigenSolver<BasisMatrix> eigen(reduced.matrix);
  BasisVector parts = eigen.eigenvectors().transpose() * reduced.right;
  const double least = kRankTolerance * static_cast<double>(n) * std::max(0.0, eigen.eigenvalues().maxCoeff());
  for (Eigen::Index i = 0; i < n; ++i) parts[i] = eigen.eigenvalues()[i] > least ? parts[i] / eigen.eigenvalues()[i] : 0.0;
  return eigen.eigenvectors() * parts;
}

// A ridge too small to bend the answer finds which unknowns are free in the one of least norm; then they are solved without it.
NnlsSolution least_norm(const BasisMatrix& matrix, const BasisVector& right) {
  BasisMatrix ridged = matrix;
  ridged.diagonal().array() += std::max(std::numeric_limits<double>::min(), kRidge * matrix.diagonal().maxCoeff());
  NnlsSolution solution = active_set(ridged, right);
  const BasisVector exact = least_norm_free(matrix, right, solution.free);
  if (exact.allFinite() && (exact.array() >= 0.0).all()) solution.weights = exact;
  solution.rank_deficient = true;
  return solution;
}

}  // namespace

NnlsSolution solve_nnls(const BasisMatrix& matrix, const BasisVector& right) {
  return lacks_rank(matrix) ? least_norm(matrix, right) : active_set(matrix, right);
}

}  // namespace lumitexel
