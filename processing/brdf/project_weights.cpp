#include "processing/brdf/project_weights.h"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <cmath>
#include <limits>

#include "processing/brdf/texel_system.h"

namespace lumitexel {
namespace {

constexpr std::size_t kMostTried = 1500;  // lumitexels that the choice of the prior looks at
constexpr double kDiffuseWidths[] = {0.05, 0.1, 0.2, 0.4, 0.8};
constexpr double kGlossWidths[] = {0.01, 0.03, 0.1, 0.3, 1.0};
BasisVector material_alone(Eigen::Index n) {
  BasisVector weights = BasisVector::Zero(n);
  weights[0] = 1.0;
  return weights;
}

// The candidates: nothing varies, then every pair of widths.
std::vector<TexelPrior> candidate_priors() {
  std::vector<TexelPrior> priors{{0.0, 0.0}};
  for (const double diffuse : kDiffuseWidths) {
    for (const double gloss : kGlossWidths) priors.push_back({diffuse, gloss});
  }
  return priors;
}

// The inverse, or where bases cannot be told apart the pseudo-inverse: what the samples' own predictions need of it is known all the same.
BasisMatrix covariance_of(const BasisMatrix& matrix, bool rank_deficient) {
  if (rank_deficient) return Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd>(matrix).pseudoInverse();  // of any size: compiled once
  return matrix.ldlt().solve(BasisMatrix::Identity(matrix.rows(), matrix.cols()));
}

// Posterior one-sigma of the prediction, pooled over the texel's own samples, relative to the prediction. matrix: the posterior's inverse
// covariance.
double relative_sigma(const TexelSystem& system, const NnlsSolution& solution, BasisMatrix matrix) {
  for (int i = 0; i < static_cast<int>(matrix.rows()); ++i) {
    if (solution.free >> i & 1u) continue;
    matrix.row(i).setZero();
    matrix.col(i).setZero();
    matrix(i, i) = 1.0;
  }
  const BasisMatrix covariance = covariance_of(matrix, solution.rank_deficient);
  double variance = 0.0, square = 1e-30;
  for (const SampleEquations& sample : system.samples) {
    for (Eigen::Index c = 0; c < sample.whitened.rows(); ++c) {
      BasisVector direction = sample.whitened.row(c).transpose();
      const double predicted = direction.dot(solution.weights);
      for (int i = 0; i < static_cast<int>(direction.size()); ++i) {
        if (!(solution.free >> i & 1u)) direction[i] = 0.0;
      }
      variance += direction.dot(covariance * direction);
      square += predicted * predicted;
    }
  }
  const double relative = std::sqrt(variance / square);
  return std::isfinite(relative) ? relative : 1.0;  // nothing is known
}

// What leaving samples out costs with one candidate.
struct LeftOut {
  double tempered = 0;  // tempered deviations
  double plain = 0;     // plain squared deviations, as a rendering shows them
};

// As Student's t with few degrees of freedom has it, whatever the material's own tails: one missed highlight must not choose the prior.
double tempered(double squares, int channels) {
  constexpr double kFreedom = 4.0;
  return (kFreedom + channels) * std::log1p(squares / kFreedom);
}

// Adds the cost of each sample of the texel, predicted from the others, per candidate.
void leave_one_out(std::span<const Observation> samples, const TexelBasis& basis, const std::vector<TexelPrior>& candidates,
                   std::vector<LeftOut>& sums) {
  const TexelSystem system = texel_system(samples, basis.channels, basis.values, basis.error);
  for (const SampleEquations& left_out : system.samples) {
    const BasisMatrix matrix = system.matrix - left_out.whitened.transpose() * left_out.whitened;
    const BasisVector right = system.right - left_out.whitened.transpose() * left_out.target;
    for (std::size_t p = 0; p < candidates.size(); ++p) {
      BasisVector weights = material_alone(matrix.rows());
      if (!nothing_varies(candidates[p])) {
        BasisMatrix with_prior = matrix;
        BasisVector right_with_prior = right;
        basis.prior.add_to(candidates[p], with_prior, right_with_prior);
        weights = solve_nnls(with_prior, right_with_prior).weights;
      }
      const double squares = (left_out.whitened * weights - left_out.target).squaredNorm();
      sums[p].plain += (left_out.predicted * weights - left_out.measured).squaredNorm();
      sums[p].tempered += tempered(squares, basis.channels);
    }
  }
}

}  // namespace

TexelWeights project_texel(std::span<const Observation> samples, const TexelBasis& basis, const TexelPrior& prior) {
  TexelWeights result;
  result.weight.assign(basis.values.bases(), 0.0f);
  result.weight[0] = 1.0f;
  result.relative_sigma = static_cast<float>(samples.empty() ? 1.0 : basis.error.relative);
  if (samples.empty() || nothing_varies(prior)) return result;
  const TexelSystem system = texel_system(samples, basis.channels, basis.values, basis.error);
  BasisMatrix matrix = system.matrix, known = basis.error.independence * system.matrix;  // samples that err together tell less
  BasisVector right = system.right, unused = system.right;
  basis.prior.add_to(prior, matrix, right);
  basis.prior.add_to(prior, known, unused);
  const NnlsSolution solution = solve_nnls(matrix, right);
  if (!solution.weights.allFinite()) return result;
  for (std::size_t k = 0; k < result.weight.size(); ++k) {
    result.weight[k] = static_cast<float>(solution.weights[static_cast<Eigen::Index>(k)]);
  }
  result.relative_sigma = static_cast<float>(relative_sigma(system, solution, known));
  return result;
}

PriorChoice choose_prior(const Observations& observations, const std::vector<std::size_t>& members, const TexelBasis& basis) {
  const std::vector<TexelPrior> candidates = candidate_priors();
  std::vector<std::size_t> tried;
  for (const std::size_t i : members) {
    if (observations.of(i).size() >= 2) tried.push_back(i);  // with one sample nothing is left to predict from
  }
  const std::size_t stride = tried.size() / kMostTried + 1;
  std::vector<std::vector<LeftOut>> sums((tried.size() + stride - 1) / stride,
                                         std::vector<LeftOut>(candidates.size()));
  oneapi::tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t k) {
    leave_one_out(observations.of(tried[k * stride]), basis, candidates, sums[k]);
  });
  PriorChoice choice;
  std::vector<LeftOut> total(candidates.size());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    for (std::size_t p = 0; p < total.size(); ++p) {
      total[p].tempered += sums[k][p].tempered;
      total[p].plain += sums[k][p].plain;
    }
    choice.samples += observations.of(tried[k * stride]).size();
  }
  std::size_t best = 0;
  for (std::size_t p = 1; p < total.size(); ++p) {
    if (total[p].tempered < total[best].tempered && total[p].plain <= total[0].plain) best = p;
  }
  const double residuals = std::max<double>(1.0, static_cast<double>(choice.samples) * observations.channels);
  choice.prior = candidates[best];
  for (const std::vector<LeftOut>& texel : sums) choice.by_texel.push_back(texel[best].tempered);
  choice.left_out_error = total[best].tempered / residuals;
  choice.left_out_error_without = total[0].tempered / residuals;
  return choice;
}

}  // namespace lumitexel
