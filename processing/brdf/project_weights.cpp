#include "processing/brdf/project_weights.h"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "processing/brdf/cluster_materials.h"

namespace lumitexel {
namespace {

constexpr std::size_t kMostTried = 3000;  // lumitexels that the choice of the prior looks at

struct SampleEquation {  // one sample in one channel
  BasisVector predicted;
  double measured = 0, weight = 0;
};

struct TexelSystem {
  std::vector<SampleEquation> equations;
  BasisMatrix matrix;
  BasisVector right;
};

TexelSystem system_of(std::span<const Observation> samples, int channels, const std::vector<LafortuneBrdf>& basis,
                      const ErrorModel& error) {
  const auto n = static_cast<Eigen::Index>(basis.size());
  TexelSystem system{{}, BasisMatrix::Zero(n, n), BasisVector::Zero(n)};
  for (const Observation& sample : samples) {
    for (int c = 0; c < channels; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      SampleEquation equation;
      equation.predicted.resize(n);
      for (Eigen::Index k = 0; k < n; ++k) {
        equation.predicted[k] = predicted_reflectance(basis[static_cast<std::size_t>(k)], c, sample.geometry);
      }
      equation.measured = static_cast<double>(sample.reflectance[channel]);
      equation.weight =
          1.0 / error.variance(equation.predicted[0], static_cast<double>(sample.variance[channel]));
      system.matrix += equation.weight * equation.predicted * equation.predicted.transpose();
      system.right += equation.weight * equation.measured * equation.predicted;
      system.equations.push_back(equation);
    }
  }
  return system;
}

BasisVector prior_mean(Eigen::Index n) {
  BasisVector mean = BasisVector::Zero(n);
  mean[0] = 1.0;
  return mean;
}

void add_prior(double width, BasisMatrix& matrix, BasisVector& right) {
  if (std::isinf(width)) return;
  const double precision = 1.0 / (width * width);
  matrix.diagonal().array() += precision;
  right[0] += precision;  // times the mean, which is (1, 0, 0, …)
}

// Posterior one-sigma of the prediction, pooled over the texel's own samples, relative to the prediction.
double relative_sigma(const TexelSystem& system, const NnlsSolution& solution, BasisMatrix matrix) {
  for (int i = 0; i < static_cast<int>(matrix.rows()); ++i) {
    if (solution.free >> i & 1u) continue;
    matrix.row(i).setZero();
    matrix.col(i).setZero();
    matrix(i, i) = 1.0;
  }
  const auto decomposition = matrix.ldlt();
  double variance = 0.0, square = 1e-30;
  for (const SampleEquation& equation : system.equations) {
    BasisVector direction = equation.predicted;
    for (int i = 0; i < static_cast<int>(direction.size()); ++i) {
      if (!(solution.free >> i & 1u)) direction[i] = 0.0;
    }
    const double predicted = equation.predicted.dot(solution.weights);
    variance += equation.weight * direction.dot(decomposition.solve(direction));
    square += equation.weight * predicted * predicted;
  }
  return std::sqrt(std::max(0.0, variance) / square);
}

// Capped squared deviations of each sample of the texel, predicted from the others; added per width.
void leave_one_out(std::span<const Observation> samples, int channels, const std::vector<LafortuneBrdf>& basis,
                   const ErrorModel& error, std::vector<double>& sums) {
  const TexelSystem system = system_of(samples, channels, basis, error);
  const auto stride = static_cast<std::size_t>(channels);
  for (std::size_t s = 0; s < samples.size(); ++s) {
    BasisMatrix matrix = system.matrix;
    BasisVector right = system.right;
    for (std::size_t e = s * stride; e < (s + 1) * stride; ++e) {
      const SampleEquation& equation = system.equations[e];
      matrix -= equation.weight * equation.predicted * equation.predicted.transpose();
      right -= equation.weight * equation.measured * equation.predicted;
    }
    for (std::size_t w = 0; w < std::size(kPriorWidths); ++w) {
      BasisVector weights = prior_mean(matrix.rows());
      if (kPriorWidths[w] > 0.0) {
        BasisMatrix with_prior = matrix;
        BasisVector right_with_prior = right;
        add_prior(kPriorWidths[w], with_prior, right_with_prior);
        weights = solve_nnls(with_prior, right_with_prior).weights;
      }
      double squares = 0.0;
      for (std::size_t e = s * stride; e < (s + 1) * stride; ++e) {
        const double residual = system.equations[e].predicted.dot(weights) - system.equations[e].measured;
        squares += system.equations[e].weight * residual * residual;
      }
      sums[w] += std::min(squares, kMostPerSample * channels);
    }
  }
}

}  // namespace

TexelWeights project_texel(std::span<const Observation> samples, int channels, const std::vector<LafortuneBrdf>& basis,
                           const ErrorModel& error, double prior_width) {
  TexelWeights result;
  result.weight.assign(basis.size(), 0.0f);
  result.weight[0] = 1.0f;
  if (samples.empty() || prior_width <= 0.0) return result;
  const TexelSystem system = system_of(samples, channels, basis, error);
  BasisMatrix matrix = system.matrix;
  BasisVector right = system.right;
  add_prior(prior_width, matrix, right);
  const NnlsSolution solution = solve_nnls(matrix, right);
  if (!solution.weights.allFinite()) return result;
  for (std::size_t k = 0; k < basis.size(); ++k) result.weight[k] = static_cast<float>(solution.weights[static_cast<Eigen::Index>(k)]);
  result.relative_sigma = static_cast<float>(relative_sigma(system, solution, matrix));
  return result;
}

PriorChoice choose_prior_width(const Observations& observations, const std::vector<std::size_t>& members,
                               const std::vector<LafortuneBrdf>& basis, const ErrorModel& error) {
  std::vector<std::size_t> tried;
  for (const std::size_t i : members) {
    if (observations.of(i).size() >= 2) tried.push_back(i);  // with one sample nothing is left to predict from
  }
  const std::size_t stride = tried.size() / kMostTried + 1;
  std::vector<std::vector<double>> sums((tried.size() + stride - 1) / stride,
                                        std::vector<double>(std::size(kPriorWidths), 0.0));
  oneapi::tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t k) {
    leave_one_out(observations.of(tried[k * stride]), observations.channels, basis, error, sums[k]);
  });
  PriorChoice choice;
  choice.left_out_error.assign(std::size(kPriorWidths), 0.0);
  for (std::size_t k = 0; k < sums.size(); ++k) {
    for (std::size_t w = 0; w < std::size(kPriorWidths); ++w) choice.left_out_error[w] += sums[k][w];
    choice.samples += observations.of(tried[k * stride]).size();
  }
  std::size_t best = 0;
  for (std::size_t w = 0; w < std::size(kPriorWidths); ++w) {
    choice.left_out_error[w] /= std::max<double>(1.0, static_cast<double>(choice.samples * static_cast<std::size_t>(observations.channels)));
    if (choice.left_out_error[w] < choice.left_out_error[best]) best = w;
  }
  choice.width = kPriorWidths[best];
  return choice;
}

}  // namespace lumitexel
