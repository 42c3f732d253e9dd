#include "processing/calibration/pose/centred_pose.h"

#include <cmath>
#include <limits>

namespace lumitexel {

CentredPose::CentredPose(const Eigen::Isometry3d& camera_from_mesh, const Eigen::Vector3d& centre_in_mesh)
    : rotation(camera_from_mesh.linear()), centre(centre_in_mesh), centre_in_camera(camera_from_mesh * centre_in_mesh) {}

Eigen::Isometry3d CentredPose::camera_from_mesh() const {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.linear() = rotation;
  result.translation() = centre_in_camera - rotation * centre;
  return result;
}

CentredPose CentredPose::moved(const PoseStep& step) const {
  CentredPose result = *this;
  // Through a quaternion, so that many steps leave a rotation a rotation.
  result.rotation = Eigen::Quaterniond(rotation_by(step.head<3>()) * rotation).normalized().toRotationMatrix();
  result.centre_in_camera += step.tail<3>();
  return result;
}

MeshExtent extent_of(const Mesh& mesh) {
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity()), high = -low;
  for (const Eigen::Vector3d& x : mesh.positions) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  MeshExtent extent{0.5 * (low + high), 0.0};
  double sum = 0.0;
  for (const Eigen::Vector3d& x : mesh.positions) sum += (x - extent.centre).squaredNorm();
  extent.radius_m = std::sqrt(sum / static_cast<double>(mesh.positions.size()));
  return extent;
}

ProjectedPoint project_with_derivatives(const CameraModel& c, const Eigen::Vector3d& p) {
  const double x = p.x() / p.z(), y = p.y() / p.z(), r2 = x * x + y * y;
  const double radial = 1.0 + r2 * (c.k1 + r2 * c.k2), slope = 2.0 * (c.k1 + 2.0 * r2 * c.k2);
  const double u = x * radial + 2.0 * c.p1 * x * y + c.p2 * (r2 + 2.0 * x * x);
  const double v = y * radial + c.p1 * (r2 + 2.0 * y * y) + 2.0 * c.p2 * x * y;
  const double mixed = x * y * slope + 2.0 * c.p1 * x + 2.0 * c.p2 * y;
  Eigen::Matrix2d distortion;
  distortion << radial + x * x * slope + 2.0 * c.p1 * y + 6.0 * c.p2 * x, mixed, mixed,
      radial + y * y * slope + 6.0 * c.p1 * y + 2.0 * c.p2 * x;
  Eigen::Matrix<double, 2, 3> perspective;
  perspective << 1.0, 0.0, -x, 0.0, 1.0, -y;
  const Eigen::Vector2d focal(c.focal_x_px, c.focal_y_px);
  ProjectedPoint result;
  result.pixel = {focal.x() * u + c.principal_x_px, focal.y() * v + c.principal_y_px};
  result.by_point = focal.asDiagonal() * distortion * perspective / p.z();
  result.by_lens.row(0) << u, 0, 1, 0, focal.x() * x * r2, focal.x() * x * r2 * r2, focal.x() * 2.0 * x * y,
      focal.x() * (r2 + 2.0 * x * x);
  result.by_lens.row(1) << 0, v, 0, 1, focal.y() * y * r2, focal.y() * y * r2 * r2, focal.y() * (r2 + 2.0 * y * y),
      focal.y() * 2.0 * x * y;
  return result;
}

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Matrix3d rotation_by(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  return angle > 0.0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Eigen::Matrix3d::Identity();
}

}  // namespace lumitexel
