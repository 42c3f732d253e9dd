// The last refinement: poses, axis, mesh, tags and lens on one side, lights, spheres and lens on the other, weighed together.
//
// No contour depends on a light and no highlight on the object, so both sides meet in the lens alone. register_turntable leaves
// the lens as a Gaussian (its unknowns' covariance), solve_lights takes that as prior and adds the highlights: what it
// gives is the lens of the joint least squares, and with it lights and spheres. The other unknowns follow by how they go
// with the lens,
//   x := x + G (lens' - lens),   C := C + G (C'_lens - C_lens) G^T,   G = C_x,lens C_lens^-1,
// which is the joint optimum to first order; steps of the lens are some hundredths of what is not linear in it.
// Silhouette distances are left as they were before: they change by less than the poses' own settling.
#pragma once

#include <vector>

#include "processing/calibration/light/light_position.h"
#include "processing/calibration/pose/register_turntable.h"

namespace lumitexel {

// The registration's lens and its covariance. Throws BadInput if it had no free lens.
RefinedLens lens_of(const TurntableRegistration& registration);

// The registration with another lens, as above. Covariances of later lights: see lights_in_mesh.
void follow_lens(TurntableRegistration& registration, const RefinedLens& lens);

struct LightInCamera {
  std::size_t view = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  // Of the lens and the position (MeasuredLight::with_lens); zero: the light knows nothing of the lens.
  Eigen::Matrix<double, kLensParameters, 3> with_lens = Eigen::Matrix<double, kLensParameters, 3>::Zero();
};

struct LightInMesh {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  // of the light's measurement and the view's pose
  double pose_share = 0;                                 // of the variance that comes from the pose
};

// Lights carried into the world with their views' poses, one result each; what light and pose have in common through the lens counts.
// Throws BadInput for a view that the registration does not have.
std::vector<LightInMesh> lights_in_mesh(const TurntableRegistration& registration, const std::vector<LightInCamera>& lights);

}  // namespace lumitexel
