#include "processing/calibration/lens/lens_calibration.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <opencv2/calib3d.hpp>
#include <random>

#include "processing/calibration/lens/lens_sigma.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/lens/board_placements.h"

namespace lumitexel {
namespace {

constexpr double kSigma_px = 0.05;

CameraModel distorted() {
  CameraModel camera{1024, 768, 2950.0, 2951.0, 516.3, 379.8};
  camera.k1 = -0.08, camera.k2 = 0.15, camera.p1 = 0.0004, camera.p2 = -0.0003;
  return camera;
}

// The largest distance, over the four corners, between where two lenses put a direction.
double corner_error_px(const CameraModel& camera, const CameraModel& truth) {
  double largest = 0;
  for (const double x : {0.0, 1024.0}) {
    for (const double y : {0.0, 768.0})
      largest = std::max(largest, (camera.project(truth.unproject({x, y})) - Eigen::Vector2d(x, y)).norm());
  }
  return largest;
}

// One chi square over all parameters and seeds: mean 8 for 8 parameters, its own scatter sqrt(16 / seeds). And each
// parameter's scatter over its stated sigma: known to 1 / sqrt(2 * seeds), so 3.3 of that.
TEST(LensCalibration, covarianceIsTheScatter) {
  const CameraModel truth = distorted();
  constexpr int kSeeds = 40;
  const double tolerance = 3.3 / std::sqrt(2.0 * kSeeds);
  LensVector squares = LensVector::Zero();
  double rms = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    // All terms are large here against their sigma, so that the choice of terms does not bias the scatter.
    CameraModel strong = truth;
    strong.k2 = 4.0, strong.p1 = 0.004, strong.p2 = -0.003;
    const auto result =
        calibrate_lens(1024, 768, placements(strong, sparse_board(), 12, kSigma_px, static_cast<std::uint64_t>(seed)));
    ASSERT_TRUE(result.usable()) << result.refusal;
    for (const bool free : result.terms) EXPECT_TRUE(free);
    const LensVector miss = lens_vector(result.camera) - lens_vector(strong);
    squares += miss.cwiseAbs2().cwiseQuotient(result.covariance.diagonal());
    rms += result.rms_px / kSeeds;
  }
  const LensVector ratio = (squares / kSeeds).cwiseSqrt();
  std::printf("scatter / stated: ");
  for (int i = 0; i < 8; ++i) {
    std::printf(" %.2f", ratio[i]);
    EXPECT_NEAR(ratio[i], 1.0, tolerance) << i;
  }
  std::printf("; RMS %.4f px\n", rms);
  EXPECT_LE(rms, 0.1);
}

// A description that is off as its sigmas say, drawn anew for every seed, and boards in the picture's middle third alone. What comes
// out is as good as it says at the corners, and no worse than the description anywhere.
TEST(LensCalibration, boardsInTheMiddleDoNotHarmTheCorners) {
  constexpr int kSeeds = 40;
  CameraDescription description;
  description.limits.width_px = 1024, description.limits.height_px = 768;
  description.lens = {2950.0, 2951.0, 516.3, 379.8, -0.08, 0.15, 0.0004, -0.0003, 29.5, 10.2, 3.2};
  const LensPrior prior = lens_prior_of(description);
  const LensMatrix root = prior.covariance.llt().matrixL();
  double described = 0, combined = 0, stated = 0, chi2 = 0, contradicted = 0;
  for (int seed = 1; seed <= kSeeds; ++seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    std::normal_distribution<double> normal;
    LensVector draw;
    for (double& one : draw) one = normal(random);
    const CameraModel truth = with_lens_vector(prior.camera, lens_vector(prior.camera) + root * draw);
    auto sightings = placements(truth, sparse_board(), 5, kSigma_px, static_cast<std::uint64_t>(seed));
    for (BoardSighting& sighting : sightings)
      std::erase_if(sighting.landmarks, [](const Landmark& l) {
        return std::abs(l.pixels[0].x() - 512) > 300 || std::abs(l.pixels[0].y() - 384) > 225;
      });
    const auto result = calibrate_lens(1024, 768, sightings, prior);
    ASSERT_TRUE(result.usable()) << result.refusal;
    const LensVector miss = lens_vector(result.camera) - lens_vector(truth);
    chi2 += miss.dot(result.covariance.llt().solve(miss)) / kLensParameters / kSeeds;
    stated += std::pow(corner_sigma_px(result.camera, result.covariance), 2) / kSeeds;
    combined += std::pow(corner_error_px(result.camera, truth), 2) / kSeeds;
    described += std::pow(corner_error_px(prior.camera, truth), 2) / kSeeds;
    for (const std::string& warning : result.warnings) contradicted += warning.find("contradict") != std::string::npos;
  }
  std::printf("corner error, rms: description %.2f px, with boards %.2f px, stated %.2f px; chi2/n %.2f\n",
              std::sqrt(described), std::sqrt(combined), std::sqrt(stated), chi2);
  EXPECT_EQ(contradicted, 0);
  // Most of what is left is the principal point, which such boards tell from their own turns to some 8 px here.
  EXPECT_LT(combined, 0.5 * described);
  // 8 numbers of 40 seeds scatter by 0.08 in chi square, four of which; the corner's square is one number a seed: 0.22.
  EXPECT_NEAR(chi2, 1.0, 0.32);
  EXPECT_NEAR(std::sqrt(combined / stated), 1.0, 0.4);
}

// The description's sigmas ten times too small: noticed, widened, and the boards win.
TEST(LensCalibration, aDescriptionThatIsSurerThanItMayBeIsNotBelieved) {
  CameraDescription description;
  description.limits.width_px = 1024, description.limits.height_px = 768;
  description.lens = {2900.0, 2900.0, 512.0, 384.0, 0.0, 0.0, 0.0, 0.0, 3.0, 1.0, 0.1};
  const auto result =
      calibrate_lens(1024, 768, placements(distorted(), wide_board(), 12, kSigma_px, 3), lens_prior_of(description));
  ASSERT_TRUE(result.usable()) << result.refusal;
  int contradicted = 0;
  for (const std::string& warning : result.warnings) contradicted += warning.find("contradict") != std::string::npos;
  EXPECT_EQ(contradicted, 1);
  EXPECT_LT(corner_error_px(result.camera, distorted()), 4.0 * corner_sigma_px(result.camera, result.covariance));
}

TEST(LensCalibration, addsNoTermsToALensWithoutDistortion) {
  CameraModel plain = distorted();
  plain.k1 = plain.k2 = plain.p1 = plain.p2 = 0;
  int none = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const auto result = calibrate_lens(1024, 768, placements(plain, sparse_board(), 6, kSigma_px, seed));
    none += result.camera.k1 == 0 && result.camera.k2 == 0 && result.camera.p1 == 0 && result.camera.p2 == 0;
  }
  std::printf("no distortion said in %d of 100\n", none);
  EXPECT_GE(none, 95);
}

TEST(LensCalibration, rejectsBentMisreadAndEmptyBoardsAndKeepsTheRest) {
  const CameraModel truth = distorted();
  auto sightings = placements(truth, wide_board(), 12, kSigma_px, 7);
  const auto clean = calibrate_lens(1024, 768, sightings);
  for (Landmark& l : sightings[3].landmarks)  // bent: as if it bulged towards the camera
    l.pixels[0] += 40.0 * l.x_in_board[0].x() * l.x_in_board[0].x() * Eigen::Vector2d(30, 20);
  std::swap(sightings[6].landmarks[0].x_in_board, sightings[6].landmarks[40].x_in_board);  // misread
  for (Landmark& l : sightings[8].landmarks) l.x_in_board[0].x() *= 1.02;  // printed with another scale along x
  sightings[10].landmarks.resize(3);
  const auto result = calibrate_lens(1024, 768, sightings);
  ASSERT_TRUE(result.usable()) << result.refusal;
  for (std::size_t i = 0; i < 12; ++i) {
    const bool bad = i == 3 || i == 6 || i == 8 || i == 10;
    EXPECT_EQ(!result.boards[i].rejected.empty(), bad) << i << ": " << result.boards[i].rejected;
    if (bad) std::printf("board %zu: %s\n", i, result.boards[i].rejected.c_str());
  }
  EXPECT_LT(result.reduced_chi2, 1.2);
  const double far = std::abs(result.camera.focal_x_px - truth.focal_x_px) / std::sqrt(result.covariance(0, 0));
  EXPECT_LT(far, 4.0);
  EXPECT_TRUE(clean.boards[3].rejected.empty());
}

TEST(LensCalibration, namesWhyItRefuses) {
  const CameraModel truth = distorted();
  const auto one = calibrate_lens(1024, 768, placements(truth, wide_board(), 1, kSigma_px, 1));
  EXPECT_FALSE(one.usable());
  EXPECT_NE(one.refusal.find("1 of 1 photographs"), std::string::npos) << one.refusal;
  const auto parallel = calibrate_lens(1024, 768, placements(truth, wide_board(), 8, kSigma_px, 1, 0.0));
  EXPECT_FALSE(parallel.usable());
  EXPECT_NE(parallel.refusal.find("parallel"), std::string::npos) << parallel.refusal;
  std::printf("%s\n", parallel.refusal.c_str());
  EXPECT_FALSE(calibrate_lens(1024, 768, {}).usable());
  BoardSighting bad = placements(truth, wide_board(), 1, kSigma_px, 1)[0];
  bad.landmarks[0].pixels[0].x() = std::nan("");
  EXPECT_BAD_INPUT(calibrate_lens(1024, 768, {bad}), "placement 0", "not finite");
}

// Boards in the left half only: usable, with a warning for each corner on the right.
TEST(LensCalibration, warnsOfEmptyCorners) {
  auto sightings = placements(distorted(), wide_board(), 12, kSigma_px, 3);
  for (BoardSighting& sighting : sightings)
    std::erase_if(sighting.landmarks, [](const Landmark& l) { return l.pixels[0].x() > 600; });
  const auto result = calibrate_lens(1024, 768, sightings);
  int right = 0;
  for (const std::string& warning : result.warnings) right += warning.find("right corner") != std::string::npos;
  EXPECT_EQ(right, 2);
}

// Four sigmas: 4 numbers at 6 focal lengths, so that one in 2000 such tests fails for nothing.
TEST(LensCalibration, focalLengthsFrom15To300mm) {
  for (const double focal_mm : {15.0, 24.0, 50.0, 100.0, 200.0, 300.0}) {
    const CameraModel truth = sensor_camera(focal_mm);
    const auto result = calibrate_lens(6000, 4000, placements(truth, wide_board(), 12, kSigma_px, 5));
    ASSERT_TRUE(result.usable()) << focal_mm << " mm: " << result.refusal;
    const LensVector miss = lens_vector(result.camera) - lens_vector(truth);
    const LensVector sigma = result.covariance.diagonal().cwiseSqrt();
    std::printf("%3.0f mm: focal %+.4f %% (stated %.4f), principal %+.2f %+.2f px (stated %.2f %.2f), RMS %.4f px\n",
                focal_mm, 100 * miss[0] / truth.focal_x_px, 100 * sigma[0] / truth.focal_x_px, miss[2], miss[3],
                sigma[2], sigma[3], result.rms_px);
    for (int i = 0; i < 4; ++i) EXPECT_LT(std::abs(miss[i]), 4.0 * sigma[i]) << focal_mm << " mm, " << i;
    EXPECT_LT(sigma[0] / truth.focal_x_px, 0.002);
    EXPECT_NEAR(result.reduced_chi2, 1.0, 0.15);
  }
}

// OpenCV puts the centre of the top-left pixel at (0, 0): the same pixels give a principal point 0.5 less.
TEST(LensCalibration, differsFromOpenCvByHalfAPixel) {
  const CameraModel truth = distorted();
  const auto sightings = placements(truth, wide_board(), 8, 0.001, 2);
  std::vector<std::vector<cv::Point3f>> board;
  std::vector<std::vector<cv::Point2f>> pixels;
  for (const BoardSighting& sighting : sightings) {
    auto& b = board.emplace_back();
    auto& p = pixels.emplace_back();
    for (const Landmark& l : sighting.landmarks) {
      b.emplace_back(static_cast<float>(l.x_in_board[0].x()), static_cast<float>(l.x_in_board[0].y()), 0.0f);
      p.emplace_back(static_cast<float>(l.pixels[0].x() - 0.5),
                     static_cast<float>(l.pixels[0].y() - 0.5));  // to OpenCV's
    }
  }
  cv::Mat matrix, distortion;
  std::vector<cv::Mat> turns, shifts;
  cv::calibrateCamera(board, pixels, {1024, 768}, matrix, distortion, turns, shifts, cv::CALIB_FIX_K3);
  const auto ours = calibrate_lens(1024, 768, sightings);
  constexpr double kClose_px = 0.1;  // float pixels and other terms
  EXPECT_NEAR(ours.camera.principal_x_px - matrix.at<double>(0, 2), 0.5, kClose_px);
  EXPECT_NEAR(ours.camera.principal_y_px - matrix.at<double>(1, 2), 0.5, kClose_px);
  EXPECT_NEAR(ours.camera.focal_x_px, matrix.at<double>(0, 0), kClose_px);
}

}  // namespace
}  // namespace lumitexel
