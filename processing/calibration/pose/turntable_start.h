// Where a turntable's registration may begin: the rig's description, and what searches in single views add to it.
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/pose/pose_search.h"
#include "processing/calibration/pose/turntable_problem.h"

namespace lumitexel {

struct TurntableStart {
  CameraModel camera;
  Eigen::Isometry3d camera_from_table = Eigen::Isometry3d::Identity();  // with the table at 0 degrees
  Eigen::Isometry3d table_from_mesh = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis_in_table = Eigen::Vector3d::UnitZ(), axis_point_in_table = Eigen::Vector3d::Zero();
};

// The description's model first. A view's search puts the mesh somewhere: moved on the table (the camera stands right), or with
// the table (the camera does not); both follow. Nothing but the description without a range.
std::vector<TurntableModel> turntable_starts(const MeshSilhouette& mesh, const std::vector<TurntableView>& views,
                                             const TurntableStart& start, const SearchRange& range, RimModel rim);

}  // namespace lumitexel
