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

TEST(NumericExtremes, ANumberThatIsNoneFailsItsRow) {
  LargestError error;
  error.see(1e-9);
  error.see(std::numeric_limits<double>::quiet_NaN());
  error.see(1e-8);
  EXPECT_FALSE((NumericCase{"", "", error.value(), 1.0}.ok()));
}

}  // namespace
}  // namespace lumitexel
