// Mirror reflection on a sphere: where an eye sees a point light, and where a seen highlight says that the light is.
//
// All points in one frame, in metres.
#pragma once

#include <Eigen/Core>
#include <optional>

namespace lumitexel {

struct MirrorSphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius_m = 0;
};

struct Ray {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();  // unit
};

// The point of the sphere at which `eye` sees `light` mirrored: the normal bisects the directions to both. Eye and
// light lie outside the sphere and not on opposite sides of its centre (there the point is not unique).
Eigen::Vector3d mirror_point(const MirrorSphere& sphere, const Eigen::Vector3d& eye, const Eigen::Vector3d& light);

// The ray that a ray from the eye is reflected into; it starts on the sphere and leads to the light. None if it misses.
std::optional<Ray> mirrored_ray(const MirrorSphere& sphere, const Ray& from_eye);

}  // namespace lumitexel
