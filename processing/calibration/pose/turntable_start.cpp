#include "processing/calibration/pose/turntable_start.h"

#include <algorithm>
#include <numbers>

namespace lumitexel {
namespace {

TurntableModel first_model(const MeshSilhouette& mesh, const TurntableStart& start, std::size_t views,
                           const Eigen::Isometry3d& table_from_mesh) {
  TurntableModel model;
  const Eigen::Isometry3d mesh_from_table = table_from_mesh.inverse();
  model.camera_from_mesh = CentredPose(start.camera_from_table * table_from_mesh, mesh.extent().centre);
  model.axis_in_mesh = (mesh_from_table.linear() * start.axis_in_table).normalized();
  model.axis_point_in_mesh = mesh_from_table * start.axis_point_in_table;
  // The axis' point nearest to the mesh, so that a tilt does not swing it away.
  const Eigen::Vector3d to_centre = mesh.extent().centre - model.axis_point_in_mesh;
  model.axis_point_in_mesh += to_centre.dot(model.axis_in_mesh) * model.axis_in_mesh;
  model.mesh_from_table = mesh_from_table;
  model.camera = start.camera;
  model.angle_offset_rad.assign(views, 0.0);
  return model;
}

}  // namespace

std::vector<TurntableModel> turntable_starts(const MeshSilhouette& mesh, const std::vector<TurntableView>& views,
                                             const TurntableStart& start, const SearchRange& range, RimModel rim) {
  const TurntableModel nominal = first_model(mesh, start, views.size(), start.table_from_mesh);
  std::vector<TurntableModel> models{nominal};
  if (range.turn_deg <= 0.0 && range.shift_m <= 0.0) return models;
  const std::size_t step = std::max<std::size_t>(1, views.size() / 3);
  for (std::size_t v = 0; v < views.size(); v += step) {
    if (views[v].contour == nullptr) continue;
    const double angle = views[v].angle_deg * std::numbers::pi / 180.0;
    const Eigen::Isometry3d turned = pose_at(nominal, angle).camera_from_mesh();
    const ViewToRegister view{mesh, *views[v].contour, start.camera};
    const auto found = search_pose(view, CentredPose(turned, mesh.extent().centre), range, rim);
    for (std::size_t k = 0; k < std::min<std::size_t>(found.size(), 4); ++k) {
      const Eigen::Isometry3d camera_from_mesh = found[k].pose.camera_from_mesh();
      const Eigen::Isometry3d at_zero = nominal.camera_from_mesh.camera_from_mesh() * turned.inverse() * camera_from_mesh;
      Eigen::Isometry3d turn_of_table = Eigen::Translation3d(start.axis_point_in_table) *
                                        Eigen::AngleAxisd(angle, start.axis_in_table.normalized()) *
                                        Eigen::Translation3d(-start.axis_point_in_table);
      const Eigen::Isometry3d table_from_mesh = (start.camera_from_table * turn_of_table).inverse() * camera_from_mesh;
      models.push_back(first_model(mesh, start, views.size(), table_from_mesh));
      TurntableModel with_camera = nominal;
      with_camera.camera_from_mesh = CentredPose(at_zero, mesh.extent().centre);
      models.push_back(with_camera);
    }
  }
  return models;
}

}  // namespace lumitexel
