// The self-test's own rows, each its own assertion, with fewer trials.
#include <gtest/gtest.h>

#include "processing/brdf/numerics/fit_cases.h"
#include "processing/brdf/numerics/kernel_cases.h"
#include "processing/brdf/numerics/numeric_self_test.h"
#include "processing/brdf/numerics/scene_cases.h"
#include "processing/brdf/numerics/trapped_run.h"

namespace lumitexel {
namespace {

constexpr std::size_t kTrials = 5000;

void expect_all_ok(const NumericCases& cases) {
  ASSERT_FALSE(cases.empty());
  for (const NumericCase& row : cases) EXPECT_TRUE(row.ok()) << to_table({row});
}

TEST(NumericExtremes, DoubleKernelsAgainst113Bits) { expect_all_ok(double_kernel_cases(kTrials)); }
TEST(NumericExtremes, FloatKernelsAgainst113Bits) { expect_all_ok(float_kernel_cases(kTrials)); }
TEST(NumericExtremes, ObjectsOfEverySize) { expect_all_ok(scene_cases(kTrials)); }
TEST(NumericExtremes, RankDeficientSystems) { expect_all_ok(rank_cases()); }
TEST(NumericExtremes, Fits) { expect_all_ok(fit_cases()); }
TEST(NumericExtremes, OneLumitexelAndMany) { expect_all_ok(extent_cases(4000)); }

TEST(NumericExtremes, NoTrapIsRaised) {
  const NumericCase row = run_trapped({{"double kernels", [] { double_kernel_cases(500); }},
                                       {"float kernels", [] { float_kernel_cases(500); }},
                                       {"rank", [] { rank_cases(); }},
                                       {"fits", [] { fit_cases(); }},
                                       {"clusters", [] { extent_cases(600); }}});
  EXPECT_TRUE(row.ok()) << row.asked;
}

// The traps are really on, and the part is named.
TEST(NumericExtremes, ATrapIsReported) {
  volatile double zero = 0.0, sink = 0.0;
  const NumericCase invalid = run_trapped({{"harmless", [] {}}, {"zero by zero", [&] { sink = zero / zero; }}, {"after", [] {}}});
  EXPECT_FALSE(invalid.ok());
  EXPECT_EQ(invalid.asked, "trap raised in: zero by zero");
  EXPECT_FALSE(run_trapped({{"one by zero", [&] { sink = 1.0 / zero; }}}).ok());
  EXPECT_FALSE(run_trapped({{"overflow", [&] { sink = (zero + 1e300) * 1e300; }}}).ok());
  EXPECT_TRUE(run_trapped({{"underflow is no trap", [&] { sink = (zero + 1e-300) * 1e-300; }}}).ok());
}

// What no arithmetic of this width can tell is not judged, and the table says of how many trials and why. A row that judged next to nothing would
// pass without being asked.
TEST(NumericExtremes, WhatIsNotJudgedIsNamed) {
  constexpr double kMostExcluded = 0.5;  // of the trials: bases are drawn over 16 decades, of which 48 bits tell half
  NumericCases cases = double_kernel_cases(kTrials);
  const NumericCases in_float = float_kernel_cases(kTrials);
  cases.insert(cases.end(), in_float.begin(), in_float.end());
  const std::string table = to_table(cases);
  int named = 0;
  for (const NumericCase& row : cases) {
    EXPECT_LT(static_cast<double>(row.excluded), kMostExcluded * kTrials) << row.name;
    EXPECT_EQ(row.excluded == 0, row.because.empty()) << row.name;
    if (row.excluded == 0) continue;
    ++named;
    EXPECT_NE(table.find(row.name + ", " + row.asked + ": " + std::to_string(row.excluded) + " trials, " + row.because), std::string::npos) << table;
  }
  EXPECT_GT(named, 0) << "the rows of small bases leave some out";
}

TEST(NumericExtremes, ANumberThatIsNoneFailsItsRow) {
  LargestError error;
  error.see(1e-9);
  error.see(std::numeric_limits<double>::quiet_NaN());
  error.see(1e-8);
  EXPECT_FALSE((NumericCase{"", "", error.value(), 1.0}.ok()));
}

}  // namespace
}  // namespace lumitexel
