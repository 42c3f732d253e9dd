#include "processing/image/censored_normal.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lumitexel {
namespace {

// The slope is that of the logarithm, by differences, over the change of formula at -30 and far beyond it.
TEST(CensoredNormal, SlopeIsThatOfTheLogarithm) {
  for (const double a : {-100.0, -40.0, -30.5, -29.5, -10.0, -1.0, 0.0, 3.0}) {
    const double delta = 1e-4, slope = (log_cdf(a + delta) - log_cdf(a - delta)) / (2.0 * delta);
    EXPECT_NEAR(log_cdf_slope(a) / slope, 1.0, 1e-4) << a;  // the series' next term at -30.5: 2 / a^4
  }
}

// Residual and weight of a censored sample divide by slope + a: that must not vanish where a sample lies far below.
TEST(CensoredNormal, CurvatureStaysPositive) {
  for (const double a : {-1000.0, -100.0, -30.1, -29.9, -5.0, 0.0, 4.0}) {
    const double h = log_cdf_slope(a);
    EXPECT_GT(h + a, 0.0) << a;
    EXPECT_LT(h * (h + a), 1.01) << a;
  }
}

}  // namespace
}  // namespace lumitexel
