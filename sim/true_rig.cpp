#include "sim/true_rig.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

// Of a rotation vector in degrees.
Eigen::Matrix3d turned(const Eigen::Vector3d& turn_deg) {
  const double angle_deg = turn_deg.norm();
  if (angle_deg == 0.0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle_deg * std::numbers::pi / 180.0, turn_deg / angle_deg).toRotationMatrix();
}

void displace_lens(LensDescription& lens, const SimulationSettings& settings) {
  lens.focal_x_px *= 1.0 + settings.lens_focal_error;
  lens.focal_y_px *= 1.0 + settings.lens_focal_error;
  lens.principal_x_px += settings.lens_principal_error_px.x();
  lens.principal_y_px += settings.lens_principal_error_px.y();
  lens.k1 += settings.lens_distortion_error[0];
  lens.k2 += settings.lens_distortion_error[1];
  lens.p1 += settings.lens_distortion_error[2];
  lens.p2 += settings.lens_distortion_error[3];
}

void displace_camera(Eigen::Isometry3d& camera_from_rig, const SimulationSettings& settings) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  if (settings.camera_position_error_m == none && settings.camera_rotation_error_deg == none) return;
  const Eigen::Vector3d position = camera_from_rig.inverse().translation() + settings.camera_position_error_m;
  camera_from_rig.linear() = turned(settings.camera_rotation_error_deg) * camera_from_rig.linear();
  camera_from_rig.translation() = -(camera_from_rig.linear() * position);
}

void displace_table(TurntableDescription& table, const SimulationSettings& settings) {
  table.axis_point_in_rig += settings.table_axis_point_error_m;
  const Eigen::Vector2d& tilt = settings.table_axis_tilt_deg;
  if (tilt == Eigen::Vector2d::Zero()) return;
  table.axis_direction_in_rig = (turned({0.0, tilt.y(), 0.0}) * turned({tilt.x(), 0.0, 0.0}) *
                                 table.axis_direction_in_rig).normalized();
}

void displace_card(RigDescription& rig, const SimulationSettings& settings) {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  if (settings.card_shift_m == none && settings.card_turn_deg == none) return;
  GrayCardDescription& card = rig.gray_card;
  const Eigen::Matrix3d turn = turned(settings.card_turn_deg);
  const Eigen::Vector3d centre = card.centre_in_rig;
  card.centre_in_rig += settings.card_shift_m;
  card.normal_in_rig = turn * card.normal_in_rig;
  card.up_in_rig = turn * card.up_in_rig;
  for (TagDescription& tag : rig.tags) {
    if (std::find(card.tag_ids.begin(), card.tag_ids.end(), tag.id) == card.tag_ids.end()) continue;
    tag.centre = card.centre_in_rig + turn * (tag.centre - centre);
    tag.normal = turn * tag.normal;
    tag.up = turn * tag.up;
  }
}

}  // namespace

RigDescription true_rig(const RigDescription& described, const SimulationSettings& settings) {
  RigDescription rig = described;
  displace_lens(rig.camera.lens, settings);
  displace_camera(rig.camera.camera_from_rig, settings);
  displace_table(rig.turntable, settings);
  displace_card(rig, settings);
  return rig;
}

Eigen::Isometry3d true_table_from_mesh(const SimulationSettings& settings) {
  Eigen::Isometry3d table_from_mesh = Eigen::Isometry3d::Identity();
  table_from_mesh.linear() = turned(settings.object_turn_deg);
  table_from_mesh.translation() = settings.object_shift_m;
  return table_from_mesh;
}

double vignetting_at(const CameraDescription& camera, const Eigen::Vector3d& coefficients, double x_px, double y_px) {
  const double dx = x_px - camera.lens.principal_x_px, dy = y_px - camera.lens.principal_y_px;
  const double half_diagonal_px = 0.5 * std::hypot(camera.limits.width_px, camera.limits.height_px);
  const double r2 = (dx * dx + dy * dy) / (half_diagonal_px * half_diagonal_px);
  return 1.0 + r2 * (coefficients[0] + r2 * (coefficients[1] + r2 * coefficients[2]));
}

}  // namespace lumitexel
