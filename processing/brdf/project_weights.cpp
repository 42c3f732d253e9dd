#include "processing/brdf/project_weights.h"

#include <oneapi/tbb/parallel_for.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>

#include "processing/brdf/misfit.h"

namespace lumitexel {
namespace {

constexpr std::size_t kMostTried = 1500;  // lumitexels that the choice of the prior looks at
constexpr double kDiffuseWidths[] = {0.05, 0.1, 0.2, 0.4, 0.8};
constexpr double kGlossWidths[] = {0.01, 0.03, 0.1, 0.3, 1.0};
// A weak pull on every weight, so that bases that look alike share what neither data nor prior tell apart.
constexpr double kWeightWidth = 2.0;
// Relative to at least this reflectance (1/sr): a metal has no diffuse light to vary by a fraction of.
constexpr double kFaintest = 0.01;
constexpr LobeGeometry kDiffuseGeometry{1.0, 0.7071067811865476, 0.7071067811865476};  // wi = wo, 45 degrees
constexpr LobeGeometry kGlossGeometry{0.5, 0.8660254037844387, 0.8660254037844387};    // mirror, 30 degrees

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

// Precision of the prior on the weights; its mean is (1, 0, 0, …), the material itself.
class PriorPrecision {
 public:
  PriorPrecision(const std::vector<LafortuneBrdf>& basis, int channels)
      : diffuse_(gram(basis, channels, kDiffuseGeometry)), gloss_(gram(basis, channels, kGlossGeometry)) {}

  void add_to(const TexelPrior& prior, BasisMatrix& matrix, BasisVector& right) const {
    if (std::isinf(prior.diffuse_width) && std::isinf(prior.gloss_width)) return;
    BasisMatrix precision = diffuse_ / (prior.diffuse_width * prior.diffuse_width) +
                            gloss_ / (prior.gloss_width * prior.gloss_width);
    precision.diagonal().array() += 1.0 / (kWeightWidth * kWeightWidth);
    matrix += precision;
    right += precision.col(0);
  }

 private:
  // Mean over channels of b b^T, b the bases' reflectances relative to the material's at one geometry.
  static BasisMatrix gram(const std::vector<LafortuneBrdf>& basis, int channels, const LobeGeometry& geometry) {
    const auto n = static_cast<Eigen::Index>(basis.size());
    BasisMatrix sum = BasisMatrix::Zero(n, n);
    for (int c = 0; c < channels; ++c) {
      const double own = std::max(kFaintest, evaluate(basis[0], c, geometry));
      BasisVector relative(n);
      for (Eigen::Index k = 0; k < n; ++k) relative[k] = evaluate(basis[static_cast<std::size_t>(k)], c, geometry) / own;
      sum += relative * relative.transpose() / channels;
    }
    return sum;
  }

  BasisMatrix diffuse_, gloss_;
};

bool nothing_varies(const TexelPrior& prior) { return prior.diffuse_width <= 0.0 && prior.gloss_width <= 0.0; }

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
  const double relative = std::sqrt(variance / square);
  return std::isfinite(relative) ? relative : 1.0;  // nothing is known
}

struct Candidates {
  std::vector<TexelPrior> priors = candidate_priors();
  PriorPrecision precision;
};

// What leaving samples out costs with one candidate.
struct LeftOut {
  double tempered = 0;  // as misfit() counts deviations
  double plain = 0;     // plain squared deviations, as a rendering shows them
};

// Adds the cost of each sample of the texel, predicted from the others, per candidate.
void leave_one_out(std::span<const Observation> samples, int channels, const std::vector<LafortuneBrdf>& basis,
                   const ErrorModel& error, const Candidates& candidates, std::vector<LeftOut>& sums) {
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
    for (std::size_t p = 0; p < candidates.priors.size(); ++p) {
      BasisVector weights = material_alone(matrix.rows());
      if (!nothing_varies(candidates.priors[p])) {
        BasisMatrix with_prior = matrix;
        BasisVector right_with_prior = right;
        candidates.precision.add_to(candidates.priors[p], with_prior, right_with_prior);
        weights = solve_nnls(with_prior, right_with_prior).weights;
      }
      double squares = 0.0;
      for (std::size_t e = s * stride; e < (s + 1) * stride; ++e) {
        const double residual = system.equations[e].predicted.dot(weights) - system.equations[e].measured;
        squares += system.equations[e].weight * residual * residual;
        sums[p].plain += residual * residual;
      }
      sums[p].tempered += (kFreedom + channels) * std::log1p(squares / kFreedom);
    }
  }
}

}  // namespace

TexelWeights project_texel(std::span<const Observation> samples, int channels, const std::vector<LafortuneBrdf>& basis,
                           const ErrorModel& error, const TexelPrior& prior) {
  TexelWeights result;
  result.weight.assign(basis.size(), 0.0f);
  result.weight[0] = 1.0f;
  result.relative_sigma = static_cast<float>(samples.empty() ? 1.0 : error.relative);
  if (samples.empty() || nothing_varies(prior)) return result;
  const TexelSystem system = system_of(samples, channels, basis, error);
  BasisMatrix matrix = system.matrix;
  BasisVector right = system.right;
  PriorPrecision(basis, channels).add_to(prior, matrix, right);
  const NnlsSolution solution = solve_nnls(matrix, right);
  if (!solution.weights.allFinite()) return result;
  for (std::size_t k = 0; k < basis.size(); ++k) {
    result.weight[k] = static_cast<float>(solution.weights[static_cast<Eigen::Index>(k)]);
  }
  result.relative_sigma = static_cast<float>(relative_sigma(system, solution, matrix));
  return result;
}

PriorChoice choose_prior(const Observations& observations, const std::vector<std::size_t>& members,
                         const std::vector<LafortuneBrdf>& basis, const ErrorModel& error) {
  const Candidates candidates{candidate_priors(), PriorPrecision(basis, observations.channels)};
  std::vector<std::size_t> tried;
  for (const std::size_t i : members) {
    if (observations.of(i).size() >= 2) tried.push_back(i);  // with one sample nothing is left to predict from
  }
  const std::size_t stride = tried.size() / kMostTried + 1;
  std::vector<std::vector<LeftOut>> sums((tried.size() + stride - 1) / stride,
                                         std::vector<LeftOut>(candidates.priors.size()));
  oneapi::tbb::parallel_for(std::size_t{0}, sums.size(), [&](std::size_t k) {
    leave_one_out(observations.of(tried[k * stride]), observations.channels, basis, error, candidates, sums[k]);
  });
  PriorChoice choice;
  std::vector<LeftOut> total(candidates.priors.size());
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
  choice.prior = candidates.priors[best];
  choice.left_out_error = total[best].tempered / residuals;
  choice.left_out_error_without = total[0].tempered / residuals;
  return choice;
}

}  // namespace lumitexel
