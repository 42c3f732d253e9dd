// The ends of what a bracket may be: each gives its accuracy, a flag or a refusal.
#include <gtest/gtest.h>

#include <cmath>

#include "curved_camera.h"
#include "drivers/error.h"
#include "processing/image/hdr_merge.h"
#include "test_camera.h"

namespace lumitexel {
namespace {

constexpr int kSide = 60, kPixels = kSide * kSide;
// Chi-square of 3600 degrees of freedom has a relative deviation of sqrt(2 / 3600) = 2.4 %; five of these.
constexpr double kChiSquareTolerance = 0.12;

MosaicRadiance merged_flat(const std::vector<double>& exposures_s, double rate, std::uint64_t seed) {
  TestCamera camera(test_sensor(), kSide, kSide, seed);
  const DarkLibrary darks = darks_for(camera, exposures_s, 4);
  std::vector<Frame> bracket;
  for (const double exposure_s : exposures_s)
    bracket.push_back(camera.expose(
        exposure_s, [&](int) { return rate; }, kNothing));
  return merge_bracket(bracket, darks, test_sensor());
}

double chi_square(const MosaicRadiance& merged, double rate) {
  double sum = 0.0;
  for (std::size_t i = 0; i < merged.value.size(); ++i) {
    EXPECT_TRUE(std::isfinite(merged.value[i]) && merged.variance[i] > 0.0f);
    sum += std::pow(static_cast<double>(merged.value[i]) - rate, 2) / static_cast<double>(merged.variance[i]);
  }
  return sum / static_cast<double>(merged.value.size());
}

TEST(HdrMergeExtremes, OneExposure) {
  EXPECT_NEAR(chi_square(merged_flat({0.1}, 20'000.0, 1), 20'000.0), 1.0, kChiSquareTolerance);
}

std::vector<double> thirty_exposures_s() {
  std::vector<double> exposures_s;
  for (int i = 0; i < 30; ++i) exposures_s.push_back(1e-4 * std::pow(1.4, i));  // to 1.7 s
  return exposures_s;
}

TEST(HdrMergeExtremes, ThirtyExposures) {
  const std::vector<double> exposures_s = thirty_exposures_s();
  for (const double rate : {100.0, 1e5})
    EXPECT_NEAR(chi_square(merged_flat(exposures_s, rate, 2), rate), 1.0, kChiSquareTolerance) << rate;
}

// At the light that just fills the well in one of them. The shorter ones know nearly as much: no more than the bound's
// normal noise is seen, where brackets of wider ratios depart from it (tests/bench/saturation_limit).
TEST(HdrMergeExtremes, ThirtyExposuresAtTheLimitOfOne) {
  const std::vector<double> exposures_s = thirty_exposures_s();
  const double range_dn = test_sensor().clip_dn - test_sensor().black_level_dn;
  for (const std::size_t limit : {10u, 20u, 29u}) {
    const double rate = range_dn / exposures_s[limit];
    EXPECT_NEAR(chi_square(merged_flat(exposures_s, rate, 12), rate), 1.0, kChiSquareTolerance) << limit;
  }
}

// A single exposure whose limit the light just reaches: half of its pixels are flagged, the others low, within their
// sigma.
TEST(HdrMergeExtremes, OneExposureAtItsLimit) {
  const double rate = (test_sensor().clip_dn - test_sensor().black_level_dn) / 0.1;
  const MosaicRadiance merged = merged_flat({0.1}, rate, 13);
  double sum = 0.0, usable = 0.0;
  for (std::size_t i = 0; i < merged.value.size(); ++i) {
    if (merged.flags[i] == kPixelSaturated) continue;
    ASSERT_EQ(merged.flags[i], 0);
    sum += std::pow(static_cast<double>(merged.value[i]) - rate, 2) / static_cast<double>(merged.variance[i]);
    usable += 1.0;
  }
  // The bound lies 6.5 times 3 DN of read noise below the clip, of 111 DN of shot noise: 43 % are below it.
  EXPECT_NEAR(usable / kPixels, 0.43, 5.0 * std::sqrt(0.25 / kPixels));
  // Of the normal's tail below -0.18 the mean square is 1.13.
  EXPECT_NEAR(sum / usable, 1.13, 5.0 * std::sqrt(2.0 / usable));
}

TEST(HdrMergeExtremes, OneAndThirtySaturatedOrBlackFramesAreFlagged) {
  for (const std::vector<double>& exposures_s : {std::vector<double>{0.1}, thirty_exposures_s()}) {
    const MosaicRadiance bright = merged_flat(exposures_s, 1e10, 14), black = merged_flat(exposures_s, 0.0, 15);
    int dark = 0;
    for (std::size_t i = 0; i < bright.value.size(); ++i) {
      ASSERT_EQ(bright.flags[i], kPixelSaturated);
      ASSERT_TRUE(std::isfinite(bright.value[i]) && std::isfinite(black.value[i]));
      dark += black.flags[i] == kPixelDark ? 1 : 0;
    }
    EXPECT_GT(dark, 0.995 * kPixels) << exposures_s.size();  // 3 sigma: 0.13 % are not
  }
}

TEST(HdrMergeExtremes, ExposuresInTheRatioOfAHundredThousand) {
  for (const double rate : {300.0, 3e7})
    EXPECT_NEAR(chi_square(merged_flat({1e-4, 10.0}, rate, 3), rate), 1.0, kChiSquareTolerance) << rate;
}

TEST(HdrMergeExtremes, FullySaturatedFramesAreFlagged) {
  const MosaicRadiance merged = merged_flat({0.01, 0.1}, 1e9, 4);
  const double bound = (test_sensor().usable_below_dn() - test_sensor().black_level_dn) / 0.01;
  for (std::size_t i = 0; i < merged.value.size(); ++i) {
    ASSERT_EQ(merged.flags[i], kPixelSaturated);
    ASSERT_GT(merged.value[i], 0.99 * bound);  // a lower bound of the radiance, and near the clip
    ASSERT_LT(merged.value[i], 1e9);
  }
}

TEST(HdrMergeExtremes, BlackFramesAreDarkAndKeepTheirSign) {
  const MosaicRadiance merged = merged_flat({0.01, 0.1}, 0.0, 5);
  // The shot parts are taken at estimates that are noise here, never below zero: the variance is too large, by what
  // half a normal of 3.4 DN (light) and of 1.5 DN (dark) add in electrons to 11.4 DN^2; never too small.
  EXPECT_GT(chi_square(merged, 0.0), 1.0 / 1.25);
  EXPECT_LT(chi_square(merged, 0.0), 1.0 + kChiSquareTolerance);
  int dark = 0, negative = 0;
  for (std::size_t i = 0; i < merged.value.size(); ++i) {
    dark += merged.flags[i] == kPixelDark ? 1 : 0;
    negative += merged.value[i] < 0.0f ? 1 : 0;
  }
  EXPECT_GT(dark, 0.995 * kPixels);  // 3 sigma: 0.13 % are not
  // Noise about zero is not clipped there: half of it is negative, to within five sigma of a fair coin.
  EXPECT_NEAR(negative, 0.5 * kPixels, 2.5 * std::sqrt(kPixels));
}

TEST(HdrMergeExtremes, SixteenBitsToTheClip) {
  Frame dark;
  dark.width_px = dark.height_px = 1;
  dark.bits = 16;
  dark.reported.exposure_s = 0.1;
  dark.samples = {100};
  LinearSensor sensor = test_sensor();
  sensor.black_level_dn = 100.0;
  sensor.clip_dn = 65535.0;
  DarkLibrary darks;
  darks.add(make_master_dark({dark, dark}, sensor));
  Frame frame = dark;
  frame.samples = {65535};
  EXPECT_EQ(merge_bracket({frame}, darks, sensor).flags[0], kPixelSaturated);
  frame.samples = {65000};  // below the bound
  const MosaicRadiance merged = merge_bracket({frame}, darks, sensor);
  EXPECT_EQ(merged.flags[0], 0);
  EXPECT_FLOAT_EQ(merged.value[0], 649'000.0f);
}

TEST(HdrMergeExtremes, RefusesFramesThatDoNotBelongTogether) {
  TestCamera camera(test_sensor(), 4, 4, 6);
  const DarkLibrary darks = darks_for(camera, {0.01, 0.1}, 2);
  std::vector<Frame> bracket{camera.expose(0.01, kNothing, kNothing), camera.expose(0.1, kNothing, kNothing)};
  bracket[1].reported.gain_db = 6.0;
  EXPECT_THROW(merge_bracket(bracket, darks, test_sensor()), BadInput);
  bracket[1].reported.gain_db = bracket[0].reported.gain_db;
  EXPECT_NO_THROW(merge_bracket(bracket, darks, test_sensor()));
  bracket[1].reported.exposure_s = std::nan("");
  EXPECT_THROW(merge_bracket(bracket, darks, test_sensor()), BadInput);
  EXPECT_THROW(merge_bracket({}, darks, test_sensor()), BadInput);
}

// The truth's own curve, on pixels bright enough for its slope to hold across their noise.
TEST(HdrMergeExtremes, MergesThroughAResponseCurve) {
  const CurvedResponse truth = compressive(0.3);
  const LinearSensor sensor = sensor_of_bits(14);
  const std::vector<double> exposures_s{0.004, 0.016, 0.064, 0.256};
  const double range_dn = sensor.clip_dn - sensor.black_level_dn;
  std::vector<double> codes, linears, rates;
  for (int i = 0; i <= 512; ++i) {
    codes.push_back(sensor.black_level_dn + range_dn * i / 512.0);
    linears.push_back(range_dn * truth.light(i / 512.0));
  }
  const ResponseCurve curve(codes, linears);
  const std::vector<Frame> bracket = curved_bracket(truth, sensor, 14, exposures_s, 7, 20'000, &rates);
  DarkLibrary darks;
  for (Frame frame : bracket) {
    frame.samples.assign(frame.samples.size(), static_cast<std::uint16_t>(std::lround(sensor.black_level_dn)));
    darks.add(make_master_dark({frame, frame}, sensor));
  }
  const MosaicRadiance merged = merge_bracket(bracket, darks, sensor, &curve);
  double sum = 0.0, bias = 0.0, n = 0.0;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const double truly = rates[i] * range_dn;
    if (merged.flags[i] != 0 || truly * 0.004 > 0.9 * range_dn) continue;
    const double off =
        (static_cast<double>(merged.value[i]) - truly) / std::sqrt(static_cast<double>(merged.variance[i]));
    sum += off * off;
    bias += off;
    n += 1.0;
  }
  EXPECT_GT(n, 10'000.0);
  EXPECT_NEAR(sum / n, 1.0, 5.0 * std::sqrt(2.0 / n));
  // The dark's mean is rounded to a code here: at most half a DN of 4.6 electrons' read noise, a few hundredths of a
  // sigma.
  EXPECT_NEAR(bias / n, 0.0, 0.1);
}

}  // namespace
}  // namespace lumitexel
