#include "processing/calibration/pose/turntable_equations.h"

namespace lumitexel {

TurntableUnknowns::TurntableUnknowns(bool with_tags, bool with_lens, bool with_angles, std::size_t views) {
  if (with_tags) {
    tags = count;
    count += 6;
  }
  if (with_lens) {
    lens = count;
    count += 8;
  }
  if (with_angles) {
    angles = count;
    count += static_cast<Eigen::Index>(views);
  }
}

CentredPose pose_at(const TurntableModel& model, double angle_rad) {
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle_rad, model.axis_in_mesh).toRotationMatrix();
  const CentredPose& first = model.camera_from_mesh;
  CentredPose pose = first;
  const Eigen::Vector3d from_point = first.centre - model.axis_point_in_mesh;
  pose.rotation = first.rotation * turn;
  pose.centre_in_camera += first.rotation * (turn * from_point - from_point);
  return pose;
}

std::pair<Eigen::Vector3d, Eigen::Vector3d> across(const Eigen::Vector3d& axis) {
  const Eigen::Vector3d first = axis.unitOrthogonal();
  return {first, axis.cross(first)};
}

Eigen::MatrixXd view_derivatives(const TurntableModel& model, const TurntableUnknowns& unknowns, std::size_t view,
                                 double angle_rad) {
  using U = TurntableUnknowns;
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(15, unknowns.count);
  const Eigen::Matrix3d first = model.camera_from_mesh.rotation;
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(angle_rad, model.axis_in_mesh).toRotationMatrix();
  const Eigen::Vector3d from_point = model.camera_from_mesh.centre - model.axis_point_in_mesh;
  const Eigen::Vector3d turned = turn * from_point;
  d.block<3, 3>(0, U::kPose).setIdentity();
  d.block<3, 3>(3, U::kPose) = -cross_matrix(first * (turned - from_point));
  d.block<3, 3>(3, U::kPose + 3).setIdentity();
  const auto [e1, e2] = across(model.axis_in_mesh);
  Eigen::Index k = 0;
  for (const Eigen::Vector3d& e : {e1, e2}) {
    const Eigen::Vector3d net = e - turn * e;  // exp(tilt) turn exp(-tilt) = exp(net) turn to first order
    d.block<3, 1>(0, U::kAxisTilt + k) = first * net;
    d.block<3, 1>(3, U::kAxisTilt + k) = first * net.cross(turned);
    d.block<3, 1>(3, U::kAxisPoint + k) = first * net;
    ++k;
  }
  d(6, U::kSwell) = 1.0;
  if (unknowns.lens >= 0) d.block<8, 8>(7, unknowns.lens).setIdentity();
  if (unknowns.angles >= 0) {
    const Eigen::Index column = unknowns.angles + static_cast<Eigen::Index>(view);
    d.block<3, 1>(0, column) = first * model.axis_in_mesh;
    d.block<3, 1>(3, column) = first * model.axis_in_mesh.cross(turned);
  }
  return d;
}

TurntableModel moved(const TurntableModel& model, const TurntableUnknowns& unknowns, const Eigen::VectorXd& step) {
  using U = TurntableUnknowns;
  TurntableModel result = model;
  result.camera_from_mesh = model.camera_from_mesh.moved(step.segment<6>(U::kPose));
  const auto [e1, e2] = across(model.axis_in_mesh);
  const Eigen::Vector3d tilt = step[U::kAxisTilt] * e1 + step[U::kAxisTilt + 1] * e2;
  result.axis_in_mesh = (rotation_by(tilt) * model.axis_in_mesh).normalized();
  result.axis_point_in_mesh += step[U::kAxisPoint] * e1 + step[U::kAxisPoint + 1] * e2;
  result.swell_m += step[U::kSwell];
  if (unknowns.tags >= 0) {  // about the mesh's middle, in the mesh's axes
    const Eigen::Vector3d& centre = model.camera_from_mesh.centre;
    const Eigen::Matrix3d turn = rotation_by(step.segment<3>(unknowns.tags));
    result.mesh_from_table.linear() =
        Eigen::Quaterniond(turn * model.mesh_from_table.linear()).normalized().toRotationMatrix();
    result.mesh_from_table.translation() =
        turn * (model.mesh_from_table.translation() - centre) + centre + step.segment<3>(unknowns.tags + 3);
  }
  if (unknowns.lens >= 0) result.camera = with_lens_vector(model.camera, lens_vector(model.camera) + step.segment<8>(unknowns.lens));
  if (unknowns.angles >= 0) {
    for (std::size_t v = 0; v < result.angle_offset_rad.size(); ++v)
      result.angle_offset_rad[v] += step[unknowns.angles + static_cast<Eigen::Index>(v)];
  }
  return result;
}

}  // namespace lumitexel
