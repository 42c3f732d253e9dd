// One view's contour distances as linear equations for a step of the pose.
//
// For a rim point with pixel p and outward image normal n, and the contour point q nearest to it, the distance is
// r = n . (q - p). A rim point slides over the surface as the pose changes, but along the view, which does not move its pixel: to
// first order its pixel moves like that of the fixed surface point, so d r = -n . (d pixel / d x) d x.
#pragma once

#include <vector>

#include "processing/calibration/pose/contour_lookup.h"
#include "processing/calibration/pose/mesh_silhouette.h"

namespace lumitexel {

struct SilhouetteEquation {
  double distance_px = 0;  // r, positive where the picture's contour lies outside of the mesh's
  double sigma_px = 0;     // of the contour point, from the pixels' noise alone
  double length_px = 0;    // of the contour that it stands for
  Eigen::Matrix<double, 1, 6> by_pose;  // -d r / d step, see PoseStep
  Eigen::Matrix<double, 1, 8> by_lens;  // -d r / d lens
  double by_swell = 0;                  // -d r / d (metres by which the surface is moved outwards)
  Eigen::Vector3d x_in_mesh;
};

struct SilhouetteEquations {
  std::vector<SilhouetteEquation> rows;
  double outline_px = 0;  // length of the mesh's contour in the picture, matched or not
  double matched_px = 0;  // of the part that has a contour point within reach
};

SilhouetteEquations silhouette_equations(const MeshSilhouette& mesh, const ContourLookup& contour,
                                         const CameraModel& camera, const CentredPose& pose, double reach_px,
                                         double spacing_px, RimModel model);

// Geman and McClure's weight of a distance.
inline double robust_weight(double distance, double scale) {
  const double q = distance / scale, s = 1.0 + q * q;
  return 1.0 / (s * s);
}

// 1.4826 times the median of |distance|, by length: a standard deviation that outliers do not touch. 0 without rows.
double robust_sigma_px(const std::vector<SilhouetteEquation>& rows);
double median_distance_px(const std::vector<SilhouetteEquation>& rows);

}  // namespace lumitexel
