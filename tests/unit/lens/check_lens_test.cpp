#include "processing/calibration/lens/check_lens.h"

#include <gtest/gtest.h>

#include "processing/calibration/lens/lens_calibration.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/lens/board_placements.h"

namespace lumitexel {
namespace {

constexpr double kSigma_px = 0.05;

struct Rates {
  int holds = 0, changed = 0, unclear = 0;
};

// Calibrated with one set of placements, checked with `boards` others through `now`.
Rates verdicts(const CameraModel& then, const CameraModel& now, int boards, int seeds) {
  Rates rates;
  for (int seed = 1; seed <= seeds; ++seed) {
    const auto s = static_cast<std::uint64_t>(seed);
    // A calibration drawn from its covariance: what calibrate_lens gives (tested there), without its time.
    static const LensCalibration one = calibrate_lens(6000, 4000, placements(then, wide_board(), 12, kSigma_px, 999));
    std::mt19937_64 random(s);
    std::normal_distribution<double> normal;
    const auto free = [&](int i) { return one.covariance(i, i) > 0.0; };
    LensMatrix padded = one.covariance;
    for (int i = 0; i < kLensParameters; ++i) padded(i, i) += free(i) ? 0.0 : 1e-30;
    LensVector draw;
    for (int i = 0; i < kLensParameters; ++i) draw[i] = normal(random);
    const LensVector scale = padded.diagonal().cwiseSqrt();
    const LensMatrix unit = scale.cwiseInverse().asDiagonal() * padded * scale.cwiseInverse().asDiagonal();
    const LensMatrix root = unit.llt().matrixL();
    const CameraModel calibrated = with_lens_vector(then, lens_vector(then) + LensVector(scale.asDiagonal() * (root * draw)));
    const LensCheck check = check_lens(calibrated, one.covariance, placements(now, wide_board(), boards, kSigma_px, s + 5000));
    (check.verdict == LensVerdict::Holds ? rates.holds : check.verdict == LensVerdict::Changed ? rates.changed : rates.unclear)++;
  }
  return rates;
}

CameraModel lens() {
  CameraModel camera = sensor_camera(50.0);
  camera.k1 = -0.05, camera.k2 = 0.1, camera.p1 = 3e-4, camera.p2 = -2e-4;
  return camera;
}

TEST(CheckLens, anUnchangedLensHolds) {
  const Rates rates = verdicts(lens(), lens(), 3, 100);
  std::printf("unchanged: holds %d, changed %d, unclear %d of 100\n", rates.holds, rates.changed, rates.unclear);
  EXPECT_GE(rates.holds, 95);
}

TEST(CheckLens, noticesATenthOfAPercentOfFocalLengthAndAPixelOfPrincipalPoint) {
  CameraModel longer = lens(), shifted = lens();
  longer.focal_x_px *= 1.001, longer.focal_y_px *= 1.001;
  shifted.principal_x_px += 1.0;
  const Rates focal = verdicts(lens(), longer, 3, 50), principal = verdicts(lens(), shifted, 3, 50);
  std::printf("focal + 0.1 %%: changed %d of 50; principal + 1 px: changed %d of 50\n", focal.changed, principal.changed);
  EXPECT_GE(focal.changed, 48);
  // One pixel is 4 sigma of three boards: the shift looks nearly like another pose. What is detectable is stated.
  EXPECT_GE(principal.changed, 10);
}

// The stated detectable change is noticed 19 times in 20: at least 42 of 50 (one in 100 such tests would fail for nothing).
TEST(CheckLens, statesWhatItWouldNotice) {
  const auto calibration = calibrate_lens(6000, 4000, placements(lens(), wide_board(), 12, kSigma_px, 999));
  const LensCheck check = check_lens(calibration.camera, calibration.covariance, placements(lens(), wide_board(), 3, kSigma_px, 1));
  std::printf("%s\n", check.reason.c_str());
  CameraModel changed = lens();
  changed.principal_x_px += check.detectable_principal_px;
  const Rates rates = verdicts(lens(), changed, 3, 50);
  std::printf("principal + %.2f px: changed %d of 50\n", check.detectable_principal_px, rates.changed);
  EXPECT_GE(rates.changed, 35);
}

TEST(CheckLens, isUnclearWithoutPointsOrWithABentBoard) {
  const LensMatrix covariance = LensMatrix::Zero();
  EXPECT_EQ(check_lens(lens(), covariance, {}).verdict, LensVerdict::Unclear);
  auto bent = placements(lens(), wide_board(), 2, kSigma_px, 4);
  for (Landmark& l : bent[0].landmarks) l.pixels[0].x() += 3.0 * std::sin(200.0 * l.x_in_board[0].y());
  const LensCheck check = check_lens(lens(), covariance, bent);
  EXPECT_EQ(check.verdict, LensVerdict::Unclear) << check.reason;
  LensMatrix bad = covariance;
  bad(0, 0) = std::nan("");
  EXPECT_BAD_INPUT(check_lens(lens(), bad, {}), "covariance");
}

}  // namespace
}  // namespace lumitexel
