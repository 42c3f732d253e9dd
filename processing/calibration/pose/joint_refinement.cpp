#include "processing/calibration/pose/joint_refinement.h"

#include "drivers/error.h"

namespace lumitexel {

std::vector<LightInMesh> lights_in_mesh(const TurntableRegistration& registration, const std::vector<LightInCamera>& lights) {
  std::vector<LightInMesh> result;
  for (const LightInCamera& light : lights) {
    if (light.view >= registration.views.size())
      throw BadInput("light", "view " + std::to_string(light.view), "one of the registered views");
    const RegisteredView& view = registration.views[light.view];
    const CentredPose pose(view.camera_from_mesh, registration.model.camera_from_mesh.centre);
    // x_mesh = R^T exp(-turn) (x_camera - centre - shift) + mesh's centre
    const Eigen::Vector3d arm = light.position_m - pose.centre_in_camera;
    Eigen::Matrix<double, 3, 6> by_pose;
    by_pose << pose.rotation.transpose() * cross_matrix(arm), -pose.rotation.transpose();
    const Eigen::Matrix3d from_pose = by_pose * view.covariance * by_pose.transpose();
    const Eigen::Matrix3d from_light = pose.rotation.transpose() * light.covariance * pose.rotation;
    LightInMesh moved;
    moved.position_m = pose.rotation.transpose() * arm + pose.centre;
    moved.covariance = from_pose + from_light;
    const double total = moved.covariance.trace();
    moved.pose_share = total > 0.0 ? from_pose.trace() / total : 0.0;
    result.push_back(moved);
  }
  return result;
}

}  // namespace lumitexel
