#include <Eigen/QR>

#include "processing/brdf/fit_brdf.h"
#include "processing/brdf/nnls.h"
#include "processing/brdf/numerics/fit_cases.h"
#include "processing/brdf/numerics/synthetic_observations.h"
#include "processing/brdf/project_weights.h"

namespace lumitexel {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// By trying every set of free unknowns: of the feasible optima the one of least norm.
Eigen::VectorXd least_norm_by_enumeration(const Eigen::MatrixXd& rows, const Eigen::VectorXd& values) {
  const Eigen::Index n = rows.cols();
  Eigen::VectorXd best = Eigen::VectorXd::Zero(n);
  double best_cost = values.squaredNorm();
  for (unsigned free = 1; free < 1u << n; ++free) {
    Eigen::MatrixXd reduced = rows;
    for (Eigen::Index i = 0; i < n; ++i) {
      if (!(free >> i & 1u)) reduced.col(i).setZero();
    }
    const Eigen::VectorXd x = reduced.completeOrthogonalDecomposition().solve(values);
    if ((x.array() < -1e-12).any()) continue;
    const double cost = (rows * x - values).squaredNorm(), tie = 1e-10 * values.squaredNorm();
    if (cost < best_cost - tie || (cost < best_cost + tie && x.norm() < best.norm())) {
      best = x;
      best_cost = cost;
    }
  }
  return best;
}

NumericCase rank_deficient_systems() {
  RandomNumbers random(21);
  LargestError error;
  for (int trial = 0; trial < 300; ++trial) {
    const int n = 3 + trial % 3, rank = 1 + trial % 2;
    const double scale = std::exp(random.uniform(-20.0, 20.0));
    Eigen::MatrixXd rows(rank, n);
    Eigen::VectorXd values(rank);
    for (int i = 0; i < rank; ++i) {
      for (int j = 0; j < n; ++j) rows(i, j) = scale * random.uniform(0.0, 1.0);
      values[i] = scale * random.uniform(-0.2, 1.0);
    }
    const NnlsSolution solution = solve_nnls(rows.transpose() * rows, rows.transpose() * values);
    const Eigen::VectorXd wanted = least_norm_by_enumeration(rows, values);
    error.see(solution.rank_deficient && solution.converged ? (solution.weights - wanted).norm() / std::max(1.0, wanted.norm()) : kInfinity);
  }
  return {"rank 1 and 2 in 3 to 5 unknowns", "solve_nnls: distance to the answer of least norm, and the flag", error.value(), 1e-6};
}

NumericCase regular_systems() {
  RandomNumbers random(22);
  double flagged = 0.0;
  for (int trial = 0; trial < 300; ++trial) {
    Eigen::MatrixXd rows(12, 6);
    for (Eigen::Index i = 0; i < rows.size(); ++i) rows.data()[i] = random.uniform();
    flagged += solve_nnls(rows.transpose() * rows, rows.transpose() * Eigen::VectorXd::Ones(12)).rank_deficient;
  }
  return {"full rank, 12 samples for 6 unknowns", "solve_nnls: systems flagged", flagged, 0.0};
}

NumericCase collinear_bases() {
  const Brdf truth = shiny_brdf(0.1, 1.0, 30.0);
  const std::vector<Brdf> basis(4, truth);
  const Observations observations = random_observations(truth, 20, 5, 0.0, 23);
  LargestError error;
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    const TexelWeights weights = project_texel(observations.of(i), TexelBasis(basis, {}), {kInfinity, kInfinity});
    for (const float weight : weights.weight) error.see(static_cast<double>(weight) - 0.25);
    error.see(std::isfinite(weights.relative_sigma) ? 0.0 : kInfinity);
  }
  return {"four bases all the same", "project_texel: weights off a quarter each", error.value(), 1e-5};
}

NumericCase unseen_lobe() {
  const Brdf truth = shiny_brdf(0.1, 1.0, 3000.0);
  Observations observations;
  observations.channels = 3;
  RandomNumbers random(24);
  while (observations.samples.size() < 200) {
    const Observation sample = random_sample(truth, 0.0, random);
    if (sample.geometry.mirror_gap > 0.3) observations.samples.push_back(sample);
  }
  observations.first.push_back(observations.samples.size());
  const BrdfFit fit = fit_brdf(truth, all_samples(observations), {});
  return {"a lobe that no sample saw", "fit_brdf: flag, finite covariance", fit.rank_deficient && fit.covariance.allFinite() ? 0.0 : kInfinity, 0.0};
}

}  // namespace

NumericCases rank_cases() { return {rank_deficient_systems(), regular_systems(), collinear_bases(), unseen_lobe()}; }

}  // namespace lumitexel
