// A pose of the mesh before the camera, taken about a point of the mesh, and the derivatives of what it shows.
//
// x_in_camera = rotation (X - centre) + centre_in_camera. A step (turn, shift), three radians and three metres, makes
// rotation := exp(turn) rotation and centre_in_camera += shift. With the centre in the object, turn and shift are
// hardly correlated, and a mesh given a kilometre from its origin loses no digit.
#pragma once

#include <Eigen/Geometry>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/lens/lens_vector.h"
#include "processing/surface/mesh.h"

namespace lumitexel {

using PoseStep = Eigen::Matrix<double, 6, 1>;
using PoseCovariance = Eigen::Matrix<double, 6, 6>;  // of a PoseStep: rad^2, rad m, m^2; axes of the camera

struct CentredPose {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  // in the mesh's frame
  Eigen::Vector3d centre_in_camera = Eigen::Vector3d::Zero();

  CentredPose() = default;
  CentredPose(const Eigen::Isometry3d& camera_from_mesh, const Eigen::Vector3d& centre_in_mesh);
  Eigen::Isometry3d camera_from_mesh() const;
  Eigen::Vector3d in_camera(const Eigen::Vector3d& x_in_mesh) const {
    return rotation * (x_in_mesh - centre) + centre_in_camera;
  }
  CentredPose moved(const PoseStep& step) const;
};

// The middle of the mesh's box, and the rms distance of its vertices from it.
struct MeshExtent {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius_m = 0;
};
MeshExtent extent_of(const Mesh& mesh);

// A pixel and its derivatives by the point in the camera's frame and by the lens.
struct ProjectedPoint {
  Eigen::Vector2d pixel;
  Eigen::Matrix<double, 2, 3> by_point;
  Eigen::Matrix<double, 2, kLensParameters> by_lens;
};
ProjectedPoint project_with_derivatives(const CameraModel& camera, const Eigen::Vector3d& x_in_camera);

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);  // cross_matrix(v) w = v x w
Eigen::Matrix3d rotation_by(const Eigen::Vector3d& turn);

}  // namespace lumitexel
