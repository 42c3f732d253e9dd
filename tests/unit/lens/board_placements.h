// Placements as a careful photographer makes them: the board over the whole picture, tilted each time another way.
#pragma once

#include <random>

#include "tests/unit/lens/board_pictures.h"

namespace lumitexel {

inline BoardDescription wide_board(double pitch_m = 0.02) {
  BoardDescription board;
  board.columns = 10, board.rows = 7;
  board.pitch_m = pitch_m;
  return board;
}

// As wide with fewer points: what takes many seeds takes less time.
inline BoardDescription sparse_board() {
  BoardDescription board;
  board.columns = 6, board.rows = 4;
  board.pitch_m = 0.036;
  return board;
}

// A camera whose sensor is 24 x 16 mm with 6000 x 4000 pixels.
inline CameraModel sensor_camera(double focal_mm) {
  const double focal_px = focal_mm * 6000.0 / 24.0;
  return {6000, 4000, focal_px, 1.0003 * focal_px, 3012.0, 1985.5};
}

// The board is about 0.6 picture widths wide and moves over the picture; tilts up to `tilt_deg` about both axes.
inline std::vector<BoardSighting> placements(const CameraModel& camera, const BoardDescription& board, int count,
                                             double sigma_px, std::uint64_t seed, double tilt_deg = 35.0) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> spread(-1.0, 1.0);
  const double width_m = board.pitch_m * (board.columns - 1);
  std::vector<BoardSighting> sightings;
  for (int i = 0; i < count; ++i) {
    const double distance = camera.focal_x_px * width_m / (0.6 * camera.width_px) * (1.0 + 0.2 * spread(random));
    const double view_m = distance * camera.width_px / camera.focal_x_px;
    const double x = spread(random), y = spread(random), turn = 10 * spread(random) + 90.0 * (i % 4);
    const double right = 0.2 * view_m * ((i & 1) ? 1 : -1) * (0.5 + 0.5 * x * x),
                 down = 0.12 * view_m * ((i & 2) ? 1 : -1) * (0.5 + 0.5 * y * y);
    const Eigen::Isometry3d pose = board_pose(distance, tilt_deg * x, tilt_deg * y, turn, right, down);
    sightings.push_back(noisy_sighting(camera, board, pose, sigma_px, seed * 1000 + static_cast<std::uint64_t>(i),
                                       "placement " + std::to_string(i)));
  }
  return sightings;
}

}  // namespace lumitexel
