#include "processing/image/fit_response.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "curved_camera.h"
#include "drivers/error.h"
#include "processing/image/hdr_merge.h"

namespace lumitexel {
namespace {

const std::vector<double> kExposures_s{0.004, 0.012, 0.060, 0.252};

// Errors over all of the usable range, the worst of the seeds. tests/bench/response_table does more of them.
void expect_half_a_percent(const CurvedResponse& truth, int bits, int seeds, int pixels, int kinks = 0) {
  const LinearSensor sensor = sensor_of_bits(bits);
  double worst = 0.0;
  for (std::uint64_t seed = 1; seed <= static_cast<std::uint64_t>(seeds); ++seed) {
    const ResponseFit fit = fit_response({curved_bracket(truth, sensor, bits, kExposures_s, seed, pixels)}, sensor);
    ASSERT_TRUE(fit.curve) << truth.name << bits << fit.why;
    EXPECT_EQ(fit.kinks, kinks) << truth.name << bits;
    for (const double error : response_errors(fit, truth, sensor)) worst = std::max(worst, std::abs(error));
    // The scale is fixed at half the range, so a unit of linear_dn has fewer electrons where the curve is steeper
    // above.
    const double electrons_per_dn = sensor.electrons_per_dn * truth.light(0.5) / 0.5;
    EXPECT_TRUE(fit.electrons_measured || bits == 8);  // rounding to 8 bits may hide shot noise
    if (fit.electrons_measured) {
      EXPECT_NEAR(fit.electrons_per_dn / electrons_per_dn, 1.0, 0.05) << truth.name << bits;
    }
  }
  std::printf("%2d bits %-16s largest error %.5f\n", bits, truth.name.c_str(), worst);
  EXPECT_LT(worst, 0.005) << truth.name << bits;
}

TEST(FitResponse, IsWithinHalfAPercentForACompressiveSensor) {
  for (const int bits : {8, 14}) expect_half_a_percent(compressive(0.3), bits, 1, 40'000);
}
TEST(FitResponse, IsWithinHalfAPercentForGamma) {
  for (const int bits : {8, 14}) expect_half_a_percent(gamma_response(2.2), bits, 1, 40'000);
}
// The kink lies at 56 electrons of 18,000; without it the error is 0.5 to 0.7 %.
TEST(FitResponse, IsWithinHalfAPercentForSrgb) {
  for (const int bits : {8, 14}) expect_half_a_percent(srgb_response(), bits, 1, 160'000, 1);
}
// A curve on which nothing was tuned.
TEST(FitResponse, IsWithinHalfAPercentForRec709) { expect_half_a_percent(rec709_response(), 14, 1, 160'000, 1); }

// A kink is one of the curve, not of its noise.
TEST(FitResponse, FindsNoKinkInSmoothCurves) {
  constexpr int kSeeds = 7, kPixels = 6000;
  const LinearSensor sensor = sensor_of_bits(14);
  int kinks = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    for (const CurvedResponse& truth : {compressive(0.3), gamma_response(2.2)})
      kinks += fit_response({curved_bracket(truth, sensor, 14, kExposures_s, seed, kPixels)}, sensor).kinks;
  }
  // Evidence of equal odds or better for a kink of noise has a chance of a few percent: two of 14 are rare.
  EXPECT_LE(kinks, 1);
}

TEST(FitResponse, FindsALinearSensorLinear) {
  constexpr int kSeeds = 50;
  for (const int bits : {14}) {
    const LinearSensor sensor = sensor_of_bits(bits);
    int curves = 0;
    double chi_square = 0.0;
    for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
      const ResponseFit fit =
          fit_response({curved_bracket(straight(), sensor, bits, kExposures_s, seed, 1000)}, sensor);
      ASSERT_TRUE(fit.determined);
      curves += fit.curve ? 1 : 0;
      chi_square += fit.chi_square / fit.freedoms / kSeeds;
    }
    std::printf("%2d bits: %d of %d linear sensors got a curve; mean chi2/n %.3f\n", bits, curves, kSeeds, chi_square);
    EXPECT_LE(curves, 3) << bits;  // 1 % each: four or more have a chance of 0.2 %
  }
}

TEST(FitResponse, KnowsItsSigma) {
  constexpr int kSeeds = 40;
  const LinearSensor sensor = sensor_of_bits(14);
  const CurvedResponse truth = compressive(0.3);
  const double range_dn = sensor.clip_dn - sensor.black_level_dn, scale = 0.5 / truth.light(0.5);
  double chi_square = 0.0, n = 0.0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const ResponseFit fit = fit_response({curved_bracket(truth, sensor, 14, kExposures_s, seed, 1500)}, sensor);
    for (const std::size_t i : {16u, 28u, 40u, 60u}) {
      const ResponsePoint& point = fit.points.at(i);
      const double light = scale * truth.light((point.code_dn - sensor.black_level_dn) / range_dn) * range_dn;
      chi_square += std::pow((point.linear_dn / light - 1.0) / point.relative_sigma, 2);
      n += 1.0;
    }
  }
  std::printf("chi2/n %.3f of %g points\n", chi_square / n, n);
  // 160 values, four of a seed correlated: as 40 independent ones they scatter by 0.22; three of these.
  EXPECT_NEAR(chi_square / n, 1.0, 0.67);
}

TEST(FitResponse, SaysWhatIsLackingOrRefuses) {
  const LinearSensor sensor = sensor_of_bits(14);
  std::vector<Frame> black = curved_bracket(straight(), sensor, 14, kExposures_s, 1, 1000);
  for (Frame& frame : black) frame.samples.assign(frame.samples.size(), 0);
  EXPECT_FALSE(fit_response({black}, sensor).determined);
  for (Frame& frame : black) frame.samples.assign(frame.samples.size(), 16383);
  const ResponseFit saturated = fit_response({black}, sensor);
  EXPECT_FALSE(saturated.determined || saturated.curve);
  EXPECT_FALSE(saturated.why.empty());
  EXPECT_THROW(fit_response({}, sensor), BadInput);
  EXPECT_THROW(fit_response({{black[0]}}, sensor), BadInput);
  black[1].reported.exposure_s = -1.0;
  EXPECT_THROW(fit_response({black}, sensor), BadInput);
}

}  // namespace
}  // namespace lumitexel
