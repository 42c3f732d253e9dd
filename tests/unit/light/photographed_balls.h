// The photographs of shared data uw-spheres made ready: pixels of the gray ball with their true normals, and directions.
#pragma once

#include <filesystem>

#include "processing/calibration/light/ball_in_picture.h"
#include "processing/calibration/light/directional_lights.h"

namespace lumitexel {

struct PhotographedBalls {
  BallInPicture mirror, gray;
  std::vector<Eigen::Vector3d> given, mirrored;  // lights.txt; from the mirror ball
  std::vector<double> mirrored_sigma_rad;
  // fitted, heldout: every `step`th pixel of either half; judged: every second of the held-out half, up to its mask's edge.
  std::vector<BallPixel> fitted, heldout, judged;
};

PhotographedBalls read_balls(const std::filesystem::path& folder, int step);

// Given directions, Lambert, linear, equal strengths.
DirectionalLights plain_lights(const std::vector<Eigen::Vector3d>& directions);

struct NormalErrors {
  double mean_deg = 0, median_deg = 0, p95_deg = 0;
  std::int64_t missing = 0;  // pixels without a normal; they count as 90 degrees
};
NormalErrors normal_errors(const DirectionalLights& lights, const std::vector<BallPixel>& pixels, double sigma_code);

}  // namespace lumitexel
