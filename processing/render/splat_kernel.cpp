#include "processing/render/splat_kernel.h"

#include <Eigen/LU>
#include <cmath>

namespace lumitexel {
namespace {

// One sigma of the kernel in texels, and in pixels. Any point between texels is within 0.71 steps of one of them.
constexpr double kTexelSigma = 0.45, kPixelSigma = 0.35;
constexpr double kThinnest = 0.05;  // pixels: of a texel seen from its edge, so that its ellipse can be inverted
constexpr double kBehind = 1.0;     // steps behind the nearest that still count as the same surface
constexpr double kSameDirection = 1e-6;

// Far outside the picture a lens's polynomial turns round and would bring points back into it.
bool folds_over(const CameraModel& camera, const Eigen::Vector3d& x_in_camera, const Eigen::Vector2d& pixel) {
  if (camera.k1 == 0.0 && camera.k2 == 0.0 && camera.p1 == 0.0 && camera.p2 == 0.0) return false;
  return (camera.unproject(pixel) - x_in_camera.normalized()).norm() > kSameDirection;
}

}  // namespace

bool project(const View& view, const TexturedPoint& point, const SurfacePoint& source, Splat& splat) {
  const Eigen::Vector3d x = view.camera_from_world * point.position_in_world;
  const Eigen::Matrix<double, 3, 2> steps = view.camera_from_world.linear() * source.steps;
  Eigen::Matrix2d on_screen;
  for (int axis = 0; axis < 2; ++axis) {
    const Eigen::Vector3d before = x - 0.5 * steps.col(axis), after = x + 0.5 * steps.col(axis);
    if (!(before.z() > 0.0) || !(after.z() > 0.0)) return false;
    on_screen.col(axis) = view.camera.project(after) - view.camera.project(before);
  }
  const Eigen::Matrix2d texel = kTexelSigma * kTexelSigma * on_screen * on_screen.transpose();
  const Eigen::Matrix2d covariance = texel + kPixelSigma * kPixelSigma * Eigen::Matrix2d::Identity();
  splat.centre_px = view.camera.project(x);
  if (folds_over(view.camera, x, splat.centre_px)) return false;
  splat.inverse_covariance = covariance.inverse();
  splat.inverse_solid = (texel + kThinnest * kThinnest * Eigen::Matrix2d::Identity()).inverse();
  splat.reach_px = (Splat::kReach2 * covariance.diagonal()).cwiseSqrt();
  splat.depth_m = x.z();
  splat.depth_slack_m = std::sqrt(Splat::kReach2) * kTexelSigma * (std::abs(steps(2, 0)) + std::abs(steps(2, 1)));
  splat.behind_m = kBehind * std::max(steps.col(0).norm(), steps.col(1).norm());
  const Eigen::Vector3d normal = view.camera_from_world.linear() * point.geometric_normal;
  splat.plane_in_camera = normal / normal.dot(x);
  splat.faces_camera = normal.dot(x) < 0.0;
  const Eigen::Vector2d size(view.camera.width_px, view.camera.height_px);
  return ((splat.centre_px + splat.reach_px).array() > 0.0).all() &&
         ((splat.centre_px - splat.reach_px).array() < size.array()).all();
}

}  // namespace lumitexel
