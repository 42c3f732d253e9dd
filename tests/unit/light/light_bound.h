// The Cramer-Rao bound of light positions from highlights of known sigma, and highlights to try an estimator on.
#pragma once

#include <cstdint>
#include <vector>

#include "processing/calibration/light/light_position.h"

namespace lumitexel {

struct SphereRig {
  CameraModel camera;
  SphereLine line;
  double ring_radius_m = 0.04;
  std::vector<Eigen::Vector3d> lights;  // one a view
};

// Six spheres of 2 cm, 5 cm apart, a metre away, four lights about a metre from the pivot: the simulated rig's, with the
// picture that many times as wide (1: 1024 x 768; 4: 12 Mpixel).
SphereRig simulated_sphere_rig(int scale = 1);

struct RigHighlights {
  std::vector<HighlightPixel> rings;
  std::vector<std::vector<HighlightPixel>> points;
};
// Exact ones plus independent noise of sigma_px a coordinate.
RigHighlights noisy_highlights(const SphereRig& rig, double sigma_px, std::uint64_t seed);

// 3x3 block per light of the inverse information over the line's five parameters and all lights, by differences of the
// highlights' places, which shares nothing with the solver.
std::vector<Eigen::Matrix3d> position_bounds(const SphereRig& rig, double sigma_px);

// Solves from the rings alone on: the line by sphere_line_from_rays, then everything.
LightSolution solved_lights(const SphereRig& rig, const RigHighlights& seen);

}  // namespace lumitexel
