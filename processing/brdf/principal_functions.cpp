#include "processing/brdf/principal_functions.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "processing/brdf/normal_equations.h"
#include "processing/brdf/ordered_sum.h"
#include "processing/brdf/texel_system.h"

namespace lumitexel {
namespace {

constexpr double kConvergedFall = 1e-5;
constexpr double kMostDamping = 1e6;

// The functions that move, as one vector after the other.
class PrincipalProblem {
 public:
  PrincipalProblem(const Observations& observations, LumitexelList lumitexels, const std::vector<Brdf>& basis, const ErrorModel& error,
                   const PrincipalOptions& options)
      : observations_(observations), lumitexels_(std::move(lumitexels)), material_(basis[0]), error_(error), prior_(options.prior) {
    const auto functions = std::min(basis.size(), static_cast<std::size_t>(std::max(0, options.functions)));
    for (std::size_t k = 0; k < functions; ++k) {
      layouts_.push_back(parameters_of(basis[k], refit_options({basis[k], error}, options.fit)));
      offsets_.push_back(size_);
      size_ += layouts_.back().size();
    }
  }

  Eigen::VectorXd start(const std::vector<Brdf>& basis) const {
    Eigen::VectorXd values(size_);
    for (std::size_t k = 0; k < layouts_.size(); ++k) values.segment(offsets_[k], layouts_[k].size()) = layouts_[k].from(basis[k]);
    return values;
  }

  std::vector<Brdf> basis_at(const Eigen::VectorXd& values, std::vector<Brdf> basis) const {
    for (std::size_t k = 0; k < layouts_.size(); ++k) basis[k] = layouts_[k].brdf(values.segment(offsets_[k], layouts_[k].size()));
    return basis;
  }

  Eigen::VectorXd stepped(const Eigen::VectorXd& values, const Eigen::VectorXd& step) const {
    Eigen::VectorXd reached(values.size());
    for (std::size_t k = 0; k < layouts_.size(); ++k) {
      reached.segment(offsets_[k], layouts_[k].size()) = layouts_[k].stepped(part(values, k), part(step, k));
    }
    return reached;
  }

  // Projects every lumitexel on the basis: the cost, and the weights.
  double project(const std::vector<Brdf>& basis, std::vector<BasisVector>& weights) const {
    const PriorPrecision precision(basis, observations_.channels);
    const BasisValues values(basis, material_, Precision::Double);
    weights.resize(lumitexels_.size());
    return ordered_sum(lumitexels_.size(), 0.0, [&](std::size_t l, double& sum) {
      const TexelSystem system = texel_system(observations_.of(lumitexels_[l]), observations_.channels, values, error_);
      BasisMatrix matrix = system.matrix;
      BasisVector right = system.right;
      precision.add_to(prior_, matrix, right);
      weights[l] = solve_nnls(matrix, right).weights;
      for (const SampleEquations& sample : system.samples) sum += (sample.whitened * weights[l] - sample.target).squaredNorm();
      sum += precision.cost(prior_, weights[l]);
    });
  }

  // With the weights held where projection left them: what it would move of them is second order.
  NormalEquations linearise(const Eigen::VectorXd& values, const std::vector<Brdf>& basis, const std::vector<BasisVector>& weights) const {
    const NormalEquations zero{Eigen::MatrixXd::Zero(size_, size_), Eigen::VectorXd::Zero(size_), 0.0};
    const BasisValues predictions(basis, material_, Precision::Double);
    std::vector<BrdfSlopes> models;
    for (std::size_t k = 0; k < layouts_.size(); ++k) models.emplace_back(layouts_[k], values.segment(offsets_[k], layouts_[k].size()));
    NormalEquations sums = ordered_sum(lumitexels_.size(), zero, [&](std::size_t l, NormalEquations& block) {
      const TexelSystem system = texel_system(observations_.of(lumitexels_[l]), observations_.channels, predictions, error_);
      const auto samples = observations_.of(lumitexels_[l]);
      for (std::size_t s = 0; s < samples.size(); ++s) add(models, samples[s], system.samples[s], weights[l], block);
    });
    sums.matrix = sums.matrix.selfadjointView<Eigen::Lower>();
    return sums;
  }

  // At a bound beyond which the cost falls, or unseen by the samples.
  std::vector<bool> held(const Eigen::VectorXd& values, const NormalEquations& equations, double cost) const {
    std::vector<bool> all;
    for (std::size_t k = 0; k < layouts_.size(); ++k) {
      const auto at_bound = layouts_[k].held(part(values, k), part(equations.gradient, k));
      const auto unseen = layouts_[k].unseen(part(equations.matrix.diagonal(), k), cost);
      for (std::size_t i = 0; i < at_bound.size(); ++i) all.push_back(at_bound[i] || unseen[i]);
    }
    return all;
  }

  std::size_t lumitexels() const { return lumitexels_.size(); }

 private:
  Eigen::VectorXd part(const Eigen::VectorXd& values, std::size_t k) const { return values.segment(offsets_[k], layouts_[k].size()); }

  void add(const std::vector<BrdfSlopes>& models, const Observation& sample, const SampleEquations& equations, const BasisVector& weights,
           NormalEquations& sums) const {
    const int channels = observations_.channels;
    const ChannelValues expected = predicted_reflectance(material_, sample.geometry);
    Eigen::MatrixXd slopes = Eigen::MatrixXd::Zero(channels, size_);
    SampleValues value;
    SampleSlopes slope;
    for (std::size_t k = 0; k < layouts_.size(); ++k) {
      const double weight = weights[static_cast<Eigen::Index>(k)];
      if (weight == 0.0) continue;
      models[k].predict(sample.geometry, value, slope);
      slopes.middleCols(offsets_[k], layouts_[k].size()) = weight * slope;
    }
    for (int c = 0; c < channels; ++c) {
      const auto channel = static_cast<std::size_t>(c);
      slopes.row(c) /= std::sqrt(error_.variance(expected[channel], static_cast<double>(sample.variance[channel])));
    }
    if (error_.whitening().size() > 0) slopes = (error_.whitening() * slopes).eval();
    const SampleValues residual = equations.whitened * weights - equations.target;
    sums.gradient.noalias() += slopes.transpose() * residual;
    sums.matrix.selfadjointView<Eigen::Lower>().rankUpdate(slopes.transpose());
  }

  const Observations& observations_;
  LumitexelList lumitexels_;
  Brdf material_;  // that the samples are weighted by
  const ErrorModel& error_;
  TexelPrior prior_;
  std::vector<BrdfParameters> layouts_;
  std::vector<int> offsets_;
  int size_ = 0;
};

LumitexelList learnt_from(const Observations& observations, const LumitexelList& members, std::size_t most, int draw) {
  LumitexelList some;
  for (const std::size_t i : members) {
    if (observations.of(i).size() >= 2) some.push_back(i);  // one sample fits any mixture
  }
  return thinned(some, most, draw);
}

}  // namespace

PrincipalFunctions principal_functions(const Observations& observations, const LumitexelList& members, const std::vector<Brdf>& basis,
                                       const ErrorModel& error, const PrincipalOptions& options) {
  PrincipalFunctions result{basis, 0.0, 0.0, 0};
  if (nothing_varies(options.prior)) return result;  // texels are the material, whatever the functions
  const PrincipalProblem problem(observations, learnt_from(observations, members, options.most_lumitexels, options.draw), basis, error, options);
  if (problem.lumitexels() == 0) return result;
  Eigen::VectorXd values = problem.start(basis);
  result.basis = problem.basis_at(values, basis);  // within the bounds
  std::vector<BasisVector> weights;
  double cost = problem.project(result.basis, weights);
  result.cost_before = cost / static_cast<double>(problem.lumitexels());
  double damping = 1e-2;
  bool converged = false;
  while (result.iterations < options.max_iterations && !converged) {
    ++result.iterations;
    const NormalEquations equations = problem.linearise(values, result.basis, weights);
    const std::vector<bool> held = problem.held(values, equations, cost);
    for (bool improved = false; !improved && !converged;) {
      Eigen::VectorXd step = damped_step(equations, held, damping);
      if (!step.allFinite()) step.setZero();
      const Eigen::VectorXd trial = problem.stepped(values, step);
      const std::vector<Brdf> trial_basis = problem.basis_at(trial, result.basis);
      std::vector<BasisVector> trial_weights;
      const double trial_cost = problem.project(trial_basis, trial_weights);
      improved = trial_cost < cost;
      if (improved) {
        converged = cost - trial_cost <= kConvergedFall * cost;
        values = trial;
        result.basis = trial_basis;
        weights = std::move(trial_weights);
        cost = trial_cost;
        damping = std::max(1e-6, damping * 0.2);
      } else {
        damping *= 8.0;
        converged = damping > kMostDamping;
      }
    }
  }
  result.cost_after = cost / static_cast<double>(problem.lumitexels());
  return result;
}

}  // namespace lumitexel
