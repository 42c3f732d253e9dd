// Photographs of flat patterns for the tests, made without the project's renderer: every pixel that sees an edge is the
// mean of many points of the pattern, spread by the pixel's square and a Gaussian lens; then shot and read noise.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/lens/landmark.h"
#include "processing/image/hdr_merge.h"
#include "rig/rig_description.h"

namespace lumitexel {

// Reflectance at a place of the board's plane.
using Pattern = std::function<double(double x_m, double y_m)>;
Pattern checkerboard_pattern(const BoardDescription& board);
Pattern tag_grid_pattern(const BoardDescription& board);

struct PictureOptions {
  double blur_px = 0.5;            // standard deviation of the lens alone
  double white_electrons = 10000;  // of a reflectance of 1
  double read_noise_e = 5;
  double falloff = 0.0;  // the light's relative change from the left edge to the right
  Mosaic mosaic = Mosaic::Mono;
};

// Noise-free electrons, and the same with noise and its (true) variance.
std::vector<float> board_electrons(const CameraModel& camera, const Eigen::Isometry3d& camera_from_board,
                                   const Pattern& pattern, const PictureOptions& options);
MosaicRadiance noisy_picture(const CameraModel& camera, const std::vector<float>& electrons,
                             const PictureOptions& options, std::uint64_t seed);

// Looks at the board's centre from `distance_m` in front of it; tilted about the picture's x and y axes, turned in its
// plane.
Eigen::Isometry3d board_pose(double distance_m, double tilt_x_deg, double tilt_y_deg, double turn_deg,
                             double right_m = 0, double down_m = 0);

// Perfect correspondences of a checkerboard with noise added; points outside the picture left out.
BoardSighting noisy_sighting(const CameraModel& camera, const BoardDescription& board, const Eigen::Isometry3d& pose,
                             double sigma_px, std::uint64_t seed, const std::string& name = "board");

}  // namespace lumitexel
