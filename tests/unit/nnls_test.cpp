#include "processing/brdf/nnls.h"

#include <gtest/gtest.h>

#include <random>

namespace lumitexel {
namespace {

struct Problem {
  BasisMatrix matrix;
  BasisVector right;
};

Problem random_problem(int unknowns, int equations, std::mt19937& random) {
  std::normal_distribution<double> normal;
  const Eigen::MatrixXd a = Eigen::MatrixXd::NullaryExpr(equations, unknowns, [&] { return normal(random); });
  const Eigen::VectorXd b = Eigen::VectorXd::NullaryExpr(equations, [&] { return normal(random); });
  return {a.transpose() * a, a.transpose() * b};
}

// Kuhn-Tucker: no gain left along any weight at zero, no slope left along any other.
void expect_optimal(const Problem& problem, const NnlsSolution& solution) {
  const BasisVector gain = problem.right - problem.matrix * solution.weights;
  const double scale = problem.right.cwiseAbs().maxCoeff() + 1e-300;
  for (Eigen::Index i = 0; i < gain.size(); ++i) {
    EXPECT_GE(solution.weights[i], 0.0);
    if (solution.weights[i] > 0.0) {
      EXPECT_NEAR(gain[i] / scale, 0.0, 1e-8);
    } else {
      EXPECT_LE(gain[i] / scale, 1e-8);
    }
  }
}

TEST(Nnls, MeetsTheOptimalityConditionsOnRandomProblems) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 500; ++trial) {
    const int unknowns = 1 + trial % kMaxBasis;
    const Problem problem = random_problem(unknowns, unknowns + 4, random);
    const NnlsSolution solution = solve_nnls(problem.matrix, problem.right);
    EXPECT_TRUE(solution.converged);
    expect_optimal(problem, solution);
  }
}

TEST(Nnls, SurvivesFewerEquationsThanUnknownsAndEqualBases) {
  std::mt19937 random(2);
  for (int trial = 0; trial < 200; ++trial) {
    Problem problem = random_problem(6, 2, random);
    const NnlsSolution solution = solve_nnls(problem.matrix, problem.right);
    EXPECT_TRUE(solution.weights.allFinite());
    EXPECT_TRUE((solution.weights.array() >= 0.0).all());
  }
  const Problem twins{BasisMatrix::Ones(2, 2), BasisVector::Ones(2)};
  const NnlsSolution solution = solve_nnls(twins.matrix, twins.right);
  EXPECT_NEAR(solution.weights.sum(), 1.0, 1e-12);
}

TEST(Nnls, LeavesADirectionWithoutInformationAtZero) {
  BasisMatrix matrix = BasisMatrix::Zero(2, 2);
  matrix(0, 0) = 4.0;
  BasisVector right = BasisVector::Zero(2);
  right[0] = 8.0;
  const NnlsSolution solution = solve_nnls(matrix, right);
  EXPECT_EQ(solution.weights[0], 2.0);
  EXPECT_EQ(solution.weights[1], 0.0);
}

}  // namespace
}  // namespace lumitexel
