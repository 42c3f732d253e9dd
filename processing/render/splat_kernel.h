// A surface point on the screen: an ellipse with a depth.
//
// The kernel is a Gaussian of covariance (0.45 texel)^2 + (0.35 pixel)^2: the texel's parallelogram as the camera sees
// it, widened so that no pixel's centre falls between points.
#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "processing/brdf/brdf.h"
#include "processing/calibration/calibrated_session.h"
#include "processing/render/surface_points.h"

namespace lumitexel {

struct Splat {
  static constexpr double kReach2 = 9.0;  // squared Mahalanobis distance up to which a kernel counts: 1.35 steps
  // A point hides what is behind it in the pixel whose centre is nearest, and 0.9 steps around, so that four neighbours
  // close the gap between them. No farther: at an outline the pixel's own blur would make the object grow.
  static constexpr double kSolid2 = 4.0, kNearestPixel = 0.5;

  Eigen::Vector2d centre_px;
  Eigen::Matrix2d inverse_covariance, inverse_solid;  // with the pixel's blur, and of the texel alone
  Eigen::Vector2d reach_px;                           // half the box that the kernel fills
  Eigen::Vector3d
      plane_in_camera;  // normal over its distance from the camera: depth = 1 / (plane . ray), ray with z = 1
  double depth_m = 0, depth_slack_m = 0, behind_m = 0;
  ChannelValues radiance{};
  bool faces_camera = false, on_screen = false;

  double distance2(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d off = pixel - centre_px;
    return off.dot(inverse_covariance * off);
  }
  bool is_solid_at(const Eigen::Vector2d& pixel) const {
    const Eigen::Vector2d off = pixel - centre_px;
    return off.cwiseAbs().maxCoeff() <= kNearestPixel || off.dot(inverse_solid * off) < kSolid2;
  }
  // Of the tangent plane, but no farther from the point's own than its kernel reaches.
  double depth_at(const Eigen::Vector3d& ray) const {
    const double along = plane_in_camera.dot(ray);
    const double depth = along > 0.0 ? 1.0 / along : depth_m;
    return std::clamp(depth, depth_m - depth_slack_m, depth_m + depth_slack_m);
  }
};

// The kernel on the screen. False where the point is behind the camera, nothing of it is on the screen, or the lens's
// distortion folds over; then the splat is not to be used.
bool project(const View& view, const TexturedPoint& point, const SurfacePoint& source, Splat& splat);

}  // namespace lumitexel
