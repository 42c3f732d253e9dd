#include <gtest/gtest.h>

#include "processing/brdf/nnls.h"

namespace lumitexel {
namespace {

constexpr double kRounding = 1e-12;

TEST(NnlsRank, AlikeUnknownsShareAlike) {
  BasisMatrix matrix = BasisMatrix::Constant(3, 3, 2.0);
  const NnlsSolution solution = solve_nnls(matrix, BasisVector::Constant(3, 6.0));
  EXPECT_TRUE(solution.rank_deficient);
  EXPECT_TRUE(solution.weights.isApprox(BasisVector::Ones(3), kRounding)) << solution.weights.transpose();
}

TEST(NnlsRank, UnknownWithoutInformationStaysAtZero) {
  BasisMatrix matrix = BasisMatrix::Zero(2, 2);
  matrix(0, 0) = 4.0;
  BasisVector right(2);
  right << 8.0, 0.0;
  const NnlsSolution solution = solve_nnls(matrix, right);
  EXPECT_TRUE(solution.rank_deficient);
  EXPECT_NEAR(solution.weights[0], 2.0, kRounding);
  EXPECT_EQ(solution.weights[1], 0.0);
}

TEST(NnlsRank, NothingKnownAtAll) {
  const NnlsSolution solution = solve_nnls(BasisMatrix::Zero(4, 4), BasisVector::Zero(4));
  EXPECT_TRUE(solution.rank_deficient);
  EXPECT_EQ(solution.weights.norm(), 0.0);
}

TEST(NnlsRank, FullRankIsNotFlagged) {
  BasisMatrix matrix = BasisMatrix::Constant(2, 2, 1.0);
  matrix(0, 0) = matrix(1, 1) = 1.0 + 1e-6;  // nearly collinear, yet told apart
  const NnlsSolution solution = solve_nnls(matrix, BasisVector::Constant(2, 1.0));
  EXPECT_FALSE(solution.rank_deficient);
}

}  // namespace
}  // namespace lumitexel
