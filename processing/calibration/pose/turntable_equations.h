// The poses of all views of one turntable, as functions of few unknowns, with derivatives.
//
// World is the mesh's frame, which leaves no gauge free: with the table at the angle a, the mesh stands before the camera by
//   camera_from_mesh(a) = camera_from_mesh(0) turn(axis, a)
// where the axis is a line in the mesh's frame (two unknowns of direction, two of place). Tags are rigid on the table, and where
// the table lies in the mesh's frame is six unknowns more; silhouettes tie mesh and camera, tags tie table and camera.
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/pose/centred_pose.h"

namespace lumitexel {

struct TurntableModel {
  CentredPose camera_from_mesh;  // at table angle 0
  Eigen::Vector3d axis_in_mesh = Eigen::Vector3d::UnitZ(), axis_point_in_mesh = Eigen::Vector3d::Zero();
  Eigen::Isometry3d mesh_from_table = Eigen::Isometry3d::Identity();  // where the tags' frame lies; used with tags only
  double swell_m = 0;                   // the surface is the mesh moved outwards by this
  CameraModel camera;
  std::vector<double> angle_offset_rad;  // one a view, added to the angle as read back
};

// Which unknowns take part, and where in the vector of all; -1: held fixed.
struct TurntableUnknowns {
  static constexpr Eigen::Index kPose = 0, kAxisTilt = 6, kAxisPoint = 8, kSwell = 10;
  Eigen::Index tags = -1, lens = -1, angles = -1, count = 11;
  TurntableUnknowns(bool with_tags, bool with_lens, bool with_angles, std::size_t views);
};

CentredPose pose_at(const TurntableModel& model, double angle_rad);

// Of a view's PoseStep, its swell and its lens (6 + 1 + 8 rows) by all unknowns.
Eigen::MatrixXd view_derivatives(const TurntableModel& model, const TurntableUnknowns& unknowns, std::size_t view,
                                 double angle_rad);
// Two unit vectors that stand across the axis: the directions of its two tilts and two shifts.
std::pair<Eigen::Vector3d, Eigen::Vector3d> across(const Eigen::Vector3d& axis);

TurntableModel moved(const TurntableModel& model, const TurntableUnknowns& unknowns, const Eigen::VectorXd& step);

}  // namespace lumitexel
