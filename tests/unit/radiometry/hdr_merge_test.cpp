#include "processing/image/hdr_merge.h"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/error.h"
#include "test_camera.h"

namespace lumitexel {
namespace {

// Each rate is one constant patch of many pixels; the merge must hit it and know by how much it misses.
TEST(HdrMerge, IsUnbiasedAndKnowsItsVariance) {
  constexpr int kWidth = 200, kHeight = 200;
  const std::vector<double> exposures{0.01, 0.08, 0.64};
  for (const double rate : {30.0, 300.0, 5'000.0, 60'000.0, 1'000'000.0}) {
    TestCamera camera(test_sensor(), kWidth, kHeight, 42);
    const DarkLibrary darks = darks_for(camera, exposures, 4);
    std::vector<Frame> bracket;
    for (const double exposure : exposures)
      bracket.push_back(camera.expose(
          exposure, [&](int) { return rate; }, kNothing));
    const MosaicRadiance merged = merge_bracket(bracket, darks, test_sensor());
    double sum = 0.0, chi_square = 0.0, variance = 0.0;
    constexpr double kPixels = kWidth * kHeight;
    for (std::size_t i = 0; i < merged.value.size(); ++i) {
      sum += merged.value[i];
      chi_square += std::pow(merged.value[i] - rate, 2) / merged.variance[i];
      variance += merged.variance[i];
    }
    EXPECT_NEAR(sum / kPixels, rate, 5.0 * std::sqrt(variance / kPixels / kPixels)) << rate;
    // Chi-square of 4e4 degrees of freedom has a relative deviation of sqrt(2 / 4e4) = 0.7 %; five of these.
    EXPECT_NEAR(chi_square / kPixels, 1.0, 0.036) << rate;
  }
}

// A long exposure must weigh in for a faint pixel: merging three must beat the shortest alone by far.
TEST(HdrMerge, UsesTheLongExposureWhereItCan) {
  const std::vector<double> exposures{0.01, 0.64};
  TestCamera camera(test_sensor(), 16, 16, 3);
  const DarkLibrary darks = darks_for(camera, exposures, 4);
  const auto rate = [](int) { return 1000.0; };
  const MosaicRadiance both =
      merge_bracket({camera.expose(0.64, rate, kNothing), camera.expose(0.01, rate, kNothing)}, darks, test_sensor());
  const double ideal =
      (1000.0 * 0.64 / 1.2 + 9.0 * 1.25) / (0.64 * 0.64);  // shot and read noise and a quarter of it again
  EXPECT_LT(both.variance[0], 1.1 * ideal);
}

TEST(HdrMerge, FlagsSaturatedDarkAndDefectivePixels) {
  const std::vector<double> exposures{0.01, 0.1};
  TestCamera camera(test_sensor(), 40, 40, 5);
  const auto hot = [](int i) { return i == 3 ? 3000.0 : 0.0; };
  DarkLibrary darks;
  for (const double exposure : exposures) {
    darks.add(make_master_dark({camera.expose(exposure, kNothing, hot), camera.expose(exposure, kNothing, hot)},
                               test_sensor()));
  }
  const auto rate = [](int i) { return i == 0 ? 1e7 : i == 1 ? 0.0 : i == 2 ? 1e6 : 1e4; };
  const MosaicRadiance merged =
      merge_bracket({camera.expose(0.01, rate, hot), camera.expose(0.1, rate, hot)}, darks, test_sensor());
  EXPECT_EQ(merged.flags[0], kPixelSaturated);
  EXPECT_EQ(merged.flags[1], kPixelDark);
  EXPECT_EQ(merged.flags[2], 0);  // saturated in the long exposure only
  EXPECT_NEAR(merged.value[2], 1e6, 5.0 * std::sqrt(merged.variance[2]));
  EXPECT_EQ(merged.flags[3], kPixelDefective);
  EXPECT_EQ(merged.flags[4], 0);
}

}  // namespace
}  // namespace lumitexel
