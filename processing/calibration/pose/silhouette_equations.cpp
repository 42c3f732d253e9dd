#include "processing/calibration/pose/silhouette_equations.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {

SilhouetteEquations silhouette_equations(const MeshSilhouette& mesh, const ContourLookup& contour,
                                         const CameraModel& camera, const CentredPose& pose, double reach_px,
                                         double spacing_px, RimModel model) {
  SilhouetteEquations equations;
  for (const RimPoint& rim : mesh.outline(camera, pose, spacing_px, model)) {
    equations.outline_px += rim.length_px;
    const ContourPoint* found = contour.nearest(rim.pixel, rim.normal, reach_px);
    if (found == nullptr) continue;
    equations.matched_px += rim.length_px;
    const Eigen::Vector3d x = pose.in_camera(rim.x_in_mesh);
    const ProjectedPoint projected = project_with_derivatives(camera, x);
    const Eigen::RowVector3d by_point = rim.normal.transpose() * projected.by_point;
    SilhouetteEquation row;
    row.distance_px = rim.normal.dot(found->pixel - rim.pixel);
    row.sigma_px = found->sigma_px;
    row.length_px = rim.length_px;
    row.by_pose.head<3>() = -by_point * cross_matrix(x - pose.centre_in_camera);
    row.by_pose.tail<3>() = by_point;
    row.by_lens = rim.normal.transpose() * projected.by_lens;
    row.by_swell = by_point * (pose.rotation * rim.normal_in_mesh);
    row.x_in_mesh = rim.x_in_mesh;
    equations.rows.push_back(row);
  }
  return equations;
}

double median_distance_px(const std::vector<SilhouetteEquation>& rows) {
  std::vector<std::pair<double, double>> distances;  // and lengths
  double total = 0.0;
  for (const SilhouetteEquation& row : rows) {
    distances.emplace_back(std::abs(row.distance_px), row.length_px);
    total += row.length_px;
  }
  std::sort(distances.begin(), distances.end());
  double sum = 0.0;
  for (const auto& [distance, length] : distances) {
    sum += length;
    if (sum >= 0.5 * total) return distance;
  }
  return 0.0;
}

double robust_sigma_px(const std::vector<SilhouetteEquation>& rows) { return 1.4826 * median_distance_px(rows); }

}  // namespace lumitexel
