#include "processing/calibration/light/white_patches.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

const CameraModel kCamera{400, 300, 800.0, 800.0, 200.0, 150.0, 0.0, 0.0, 0.0, 0.0};

BoardDescription board() {
  BoardDescription board;
  board.columns = 5;
  board.rows = 4;
  board.pitch_m = 0.02;
  return board;
}

Eigen::Isometry3d pose(double turn_rad) {
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  camera_from_board.linear() = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()) *
                               Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitY()) *
                               Eigen::AngleAxisd(std::acos(-1.0), Eigen::Vector3d::UnitX()).toRotationMatrix();
  camera_from_board.translation() = Eigen::Vector3d(0.01, -0.005, 0.6);
  return camera_from_board;
}

// White squares shine by 100 + 1000 times their x on the board, black ones by 5.
MosaicRadiance picture(const Eigen::Isometry3d& camera_from_board, int white_parity) {
  MosaicRadiance image;
  image.width = kCamera.width_px, image.height = kCamera.height_px;
  image.mosaic = Mosaic::Rggb;
  const Eigen::Isometry3d board_from_camera = camera_from_board.inverse();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const Eigen::Vector3d ray = board_from_camera.linear() * kCamera.unproject({x + 0.5, y + 0.5});
      const Eigen::Vector3d eye = board_from_camera.translation(), at = eye - eye.z() / ray.z() * ray;
      const int column = static_cast<int>(std::floor(at.x() / 0.02 + 3.0)), row = static_cast<int>(std::floor(at.y() / 0.02 + 2.5));
      const bool white = (column + row + 100) % 2 == white_parity;
      image.value.push_back(white ? static_cast<float>(100.0 + 1000.0 * at.x()) : 5.0f);
      image.variance.push_back(1.0f);
      image.flags.push_back(0);
    }
  }
  return image;
}

TEST(WhitePatches, AreTheBrighterSquaresWhicheverTheyAre) {
  for (const int parity : {0, 1}) {
    const auto patches = white_patches(picture(pose(0.2), parity), kCamera, pose(0.2), board());
    ASSERT_EQ(patches.size(), 15u);  // half of 6 x 5 squares
    for (const WhitePatch& patch : patches) {
      const Eigen::Vector3d on_board = pose(0.2).inverse() * patch.position_in_camera;
      EXPECT_NEAR(on_board.z(), 0.0, 1e-12);
      EXPECT_NEAR(patch.radiance, 100.0 + 1000.0 * on_board.x(), 1e-3);  // floats
      EXPECT_LT(patch.normal_in_camera.z(), 0.0);
      EXPECT_LT(patch.variance, 0.1);
    }
  }
}

TEST(WhitePatches, LeaveOutWhatIsFlaggedOrOutside) {
  MosaicRadiance image = picture(pose(0.0), 0);
  std::fill(image.flags.begin(), image.flags.begin() + 150 * 400, static_cast<std::uint8_t>(kPixelSaturated));
  const auto patches = white_patches(image, kCamera, pose(0.0), board());
  EXPECT_GT(patches.size(), 3u);
  EXPECT_LT(patches.size(), 12u);
  for (const WhitePatch& patch : patches) EXPECT_GT(kCamera.project(patch.position_in_camera).y(), 150.0);
  Eigen::Isometry3d behind = pose(0.0);
  behind.translation().z() = -0.6;
  EXPECT_TRUE(white_patches(image, kCamera, behind, board()).empty());
}

}  // namespace
}  // namespace lumitexel
