// Pictures of a line of rough mirror spheres, by direct evaluation: a second opinion on what the fits see, quick enough for many seeds.
#pragma once

#include <cstdint>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/light/sphere_line.h"
#include "processing/image/hdr_merge.h"

namespace lumitexel {

struct RoughSpheres {
  CameraModel camera;
  SphereLine line;
  double roughness = 0.025;  // GGX
  double blur_px = 0;        // of the lens: one sigma of a Gaussian
};

// Mono, without noise, the brightest pixel at `peak`; every emitter as bright; only windows about the highlights are drawn.
MosaicRadiance picture_of(const RoughSpheres& spheres, const std::vector<Eigen::Vector3d>& emitters, double peak);

// A disc of emitters, evenly bright, at `centre` facing `faces`; a radius of 0: one.
std::vector<Eigen::Vector3d> disc_of_emitters(const Eigen::Vector3d& centre, const Eigen::Vector3d& faces, double radius_m);
std::vector<Eigen::Vector3d> ring_of_emitters(double radius_m);  // about the camera's centre

// Shot noise (values are electrons) and three of read noise.
MosaicRadiance with_noise(MosaicRadiance picture, std::uint64_t seed);

}  // namespace lumitexel
