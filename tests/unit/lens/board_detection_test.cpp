#include "processing/calibration/lens/board_detection.h"

#include <gtest/gtest.h>

#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/lens/board_pictures.h"

namespace lumitexel {
namespace {

CameraModel distorted_camera() { return {640, 480, 900.0, 902.0, 318.0, 243.5, -0.08, 0.05, 0.0004, -0.0003}; }

BoardDescription checkerboard() {
  BoardDescription board;
  board.columns = 8, board.rows = 5;
  board.pitch_m = 0.02;
  return board;
}

struct Errors {
  double rms = 0, stated = 0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
};

Errors errors_of(const BoardSighting& sighting, const CameraModel& camera, const Eigen::Isometry3d& pose,
                 bool half_turn) {
  Errors errors;
  double points = 0;
  for (const Landmark& landmark : sighting.landmarks) {
    for (std::size_t i = 0; i < landmark.pixels.size(); ++i) {
      Eigen::Vector3d x = landmark.x_in_board[i];
      if (half_turn) x.head<2>() *= -1.0;
      const Eigen::Vector2d miss = landmark.pixels[i] - camera.project(pose * x);
      errors.rms += miss.squaredNorm(), errors.mean += miss, points += 1;
    }
    errors.stated += landmark.covariance_px2.trace();
  }
  errors.rms = std::sqrt(errors.rms / (2 * points)), errors.stated = std::sqrt(errors.stated / (2 * points));
  errors.mean /= points;
  return errors;
}

// All points, in the board's frame up to half a turn, with the project's pixel centres, as good as stated. 0.8 … 1.25:
// 80 values.
TEST(BoardDetection, checkerboardCornersAreAsGoodAsTheySay) {
  const CameraModel camera = distorted_camera();
  for (const double turn : {4.0, 95.0, 200.0}) {
    const Eigen::Isometry3d pose = board_pose(0.45, 15, -20, turn);
    PictureOptions options;
    options.falloff = 0.3;
    const auto image =
        noisy_picture(camera, board_electrons(camera, pose, checkerboard_pattern(checkerboard()), options), options, 3);
    const BoardSighting sighting = detect_board(image, checkerboard(), "one");
    ASSERT_EQ(sighting.points(), 40u) << turn;
    const Errors plain = errors_of(sighting, camera, pose, false), turned = errors_of(sighting, camera, pose, true);
    const Errors& errors = plain.rms < turned.rms ? plain : turned;
    std::printf("checkerboard %.0f degrees: RMS %.4f stated %.4f mean %.4f %.4f\n", turn, errors.rms, errors.stated,
                errors.mean.x(), errors.mean.y());
    EXPECT_GT(errors.rms / errors.stated, 0.7);
    EXPECT_LT(errors.rms / errors.stated, 1.3);
    EXPECT_LT(errors.rms, 0.03);
  }
}

TEST(BoardDetection, aTagGridMayBeSeenInPart) {
  BoardDescription board;
  board.pattern = BoardDescription::Pattern::TagGrid;
  board.columns = 4, board.rows = 3;
  board.pitch_m = 0.05, board.tag_size_m = 0.035, board.first_tag_id = 20;
  const CameraModel camera = distorted_camera();
  const Eigen::Isometry3d pose = board_pose(0.45, -15, 25, 12, 0.09, 0.0);  // runs out of the picture on the right
  const auto image = noisy_picture(camera, board_electrons(camera, pose, tag_grid_pattern(board), {}), {}, 5);
  const BoardSighting bent = detect_board(image, board, "part"), sighting = detect_board(image, board, "part", camera);
  EXPECT_GE(sighting.landmarks.size(), 5u);
  EXPECT_LT(sighting.landmarks.size(), 12u);
  const Errors unaware = errors_of(bent, camera, pose, false), errors = errors_of(sighting, camera, pose, false);
  std::printf("tag grid: %zu tags, RMS %.4f stated %.4f; lens not known: RMS %.4f\n", sighting.landmarks.size(),
              errors.rms, errors.stated, unaware.rms);
  EXPECT_LT(unaware.rms, 0.03);  // bent edges taken for straight ones
  EXPECT_LT(errors.rms, 0.5 * unaware.rms);
  EXPECT_GT(errors.rms / errors.stated, 0.7);
  EXPECT_LT(errors.rms / errors.stated, 1.3);
}

TEST(BoardDetection, nothingThereGivesNoLandmarks) {
  const CameraModel camera = distorted_camera();
  const std::vector<float> gray(640 * 480, 500.0f);
  EXPECT_EQ(detect_board(noisy_picture(camera, gray, {}, 1), checkerboard(), "none").points(), 0u);
}

TEST(BoardDetection, refusesABoardWithoutSize) {
  EXPECT_BAD_INPUT(detect_board({}, BoardDescription{}, "x"), "board", "3 x 3");
}

}  // namespace
}  // namespace lumitexel
