// The last refinement's tie between poses and lights.
//
// register_turntable, given the tags and the lens's covariance, is the joint least squares over poses, axis, mesh and lens. A light
// is measured in the camera's frame, from spheres that stand still before the camera; no contour depends on it, so its solution,
// with its covariance, takes the place of its highlights, and the joint optimum has it where it was. What is left is
// to carry it into the world with the pose that the joint solution gives the view.
#pragma once

#include <vector>

#include "processing/calibration/pose/register_turntable.h"

namespace lumitexel {

struct LightInCamera {
  std::size_t view = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
};

struct LightInMesh {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of the light's measurement and the view's pose
  double pose_share = 0;                                 // of the variance that comes from the pose
};

// One result a light. Throws BadInput for a view that the registration does not have. The error that light and pose share through the
// lens is taken as independent.
std::vector<LightInMesh> lights_in_mesh(const TurntableRegistration& registration, const std::vector<LightInCamera>& lights);

}  // namespace lumitexel
