#include "processing/brdf/fit_brdf.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>

#include "processing/brdf/misfit.h"
#include "processing/brdf/normal_equations.h"

namespace lumitexel {
namespace {

constexpr double kConvergedFall = 1e-7;  // relative fall of the cost at which the iteration ends
constexpr double kLeastDamping = 1e-9, kMostDamping = 1e9;
// Share of the largest eigenvalue of the scaled normal matrix below which a direction counts as undetermined.
constexpr double kRankTolerance = 1e-12;

std::vector<bool> either(std::vector<bool> a, const std::vector<bool>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = a[i] || b[i];
  return a;
}

struct Descent {
  Eigen::VectorXd values;
  int iterations = 0;  // steps tried
  bool converged = false;
};

Descent levenberg_marquardt(const BrdfProblem& problem, const BrdfParameters& layout, Eigen::VectorXd values, int max_iterations) {
  Descent descent{std::move(values)};
  double damping = 1e-3;
  int taken = 0;  // a step that is refused costs little, and the next is shorter
  NormalEquations equations = problem.linearise(descent.values);
  while (taken < max_iterations && !descent.converged) {
    ++descent.iterations;
    const std::vector<bool> held = either(layout.held(descent.values, equations.gradient),
                                          layout.unseen(equations.matrix.diagonal(), equations.cost));
    const Eigen::VectorXd step = damped_step(equations, held, damping);
    if (!step.allFinite()) {
      damping *= 10.0;
      if (damping > kMostDamping) break;
      continue;
    }
    const Eigen::VectorXd trial = layout.stepped(descent.values, step);
    const double cost = problem.cost(trial);
    if (cost <= equations.cost) {
      descent.converged = equations.cost - cost <= kConvergedFall * equations.cost;
      descent.values = trial;
      damping = std::max(kLeastDamping, damping * 0.1);
      ++taken;
      if (!descent.converged && taken < max_iterations) equations = problem.linearise(descent.values);
    } else {
      damping *= 10.0;
      descent.converged = damping > kMostDamping;  // no direction falls
    }
  }
  return descent;
}

// Inverse of the normal matrix over the free parameters, scaled to a unit diagonal first; what is not determined gets no
// variance and sets rank_deficient.
Eigen::MatrixXd covariance_of(const NormalEquations& equations, const std::vector<bool>& held, const std::vector<bool>& unseen,
                              bool& rank_deficient) {
  const Eigen::Index n = equations.matrix.rows();
  Eigen::VectorXd scale = Eigen::VectorXd::Zero(n);
  int wanted = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double diagonal = equations.matrix(i, i);
    if (held[static_cast<std::size_t>(i)]) continue;
    const bool seen = diagonal > 0.0 && !unseen[static_cast<std::size_t>(i)];
    if (seen) scale[i] = 1.0 / std::sqrt(diagonal);
    else rank_deficient = true;
    wanted += seen;
  }
  const Eigen::MatrixXd scaled = scale.asDiagonal() * equations.matrix * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  Eigen::VectorXd inverse = Eigen::VectorXd::Zero(n);
  int determined = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    if (eigen.eigenvalues()[i] <= kRankTolerance * static_cast<double>(n)) continue;
    inverse[i] = 1.0 / eigen.eigenvalues()[i];
    ++determined;
  }
  if (determined < wanted) rank_deficient = true;
  const Eigen::MatrixXd root = scale.asDiagonal() * eigen.eigenvectors();
  return root * inverse.asDiagonal() * root.transpose();
}

void state_uncertainty(const BrdfProblem& problem, const BrdfParameters& layout, const Eigen::VectorXd& values, BrdfFit& fit) {
  const NormalEquations equations = problem.linearise(values);
  const double residuals = problem.total_weight() * layout.channels();
  fit.chi_squared = residuals > 0.0 ? equations.cost / residuals : 0.0;
  const double spread = equations.cost / std::max(1.0, residuals - layout.size());
  fit.covariance = spread * covariance_of(equations, layout.held(values, equations.gradient),
                                          layout.unseen(equations.matrix.diagonal(), equations.cost), fit.rank_deficient);
}

}  // namespace

BrdfParameters parameters_of(const Brdf& start, const BrdfFitOptions& options) {
  std::vector<LobeBounds> bounds = options.bounds;
  bounds.resize(start.lobes.size(), usual_bounds(start.family));
  return BrdfParameters(start.family, start.channels, options.shared_shape, std::move(bounds));
}

BrdfFit fit_brdf(const Brdf& start, FitSamples samples, const BrdfFitOptions& options) {
  BrdfFit fit;
  const BrdfParameters layout = parameters_of(start, options);
  Eigen::VectorXd values = layout.from(start);
  fit.brdf = layout.brdf(values);
  fit.covariance = Eigen::MatrixXd::Zero(layout.size(), layout.size());
  fit.rank_deficient = samples.empty();
  if (samples.empty()) return fit;

  BrdfProblem problem(samples, layout, options.error, options.robust);
  for (int round = 0; round < options.reweightings; ++round) {
    problem.reweight(values);
    const Descent descent = levenberg_marquardt(problem, layout, values, options.max_iterations);
    values = descent.values;
    fit.iterations += descent.iterations;
    fit.converged = descent.converged;
  }
  fit.brdf = layout.brdf(values);
  if (options.brdf_alone) return fit;
  problem.reweight(values);
  fit.misfit = misfit(fit.brdf, samples, options.error);
  state_uncertainty(problem, layout, values, fit);
  return fit;
}

Eigen::MatrixXd covariance_by_lumitexel(const Brdf& brdf, FitSamples samples, const BrdfFitOptions& options) {
  const BrdfParameters layout = parameters_of(brdf, options);
  std::size_t lumitexels = 0;
  for (std::size_t s = 0; s < samples.size(); ++s) lumitexels += s == 0 || samples[s].lumitexel != samples[s - 1].lumitexel;
  if (lumitexels < 2) return Eigen::MatrixXd::Zero(layout.size(), layout.size());
  const Eigen::VectorXd values = layout.from(brdf);
  BrdfProblem problem(samples, layout, options.error, options.robust);
  problem.reweight(values);
  const NormalEquations equations = problem.linearise(values);
  bool ignored = false;  // directions that are not determined get no variance; the fit has said so
  const Eigen::MatrixXd inverse = covariance_of(equations, layout.held(values, equations.gradient),
                                                layout.unseen(equations.matrix.diagonal(), equations.cost), ignored);
  const double few = static_cast<double>(lumitexels) / static_cast<double>(lumitexels - 1), slope = problem.robust_slope(values);
  return few / (slope * slope) * inverse * problem.scatter_by_lumitexel(values) * inverse;
}

}  // namespace lumitexel
