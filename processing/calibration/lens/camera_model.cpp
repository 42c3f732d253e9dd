#include "processing/calibration/lens/camera_model.h"

#include <Eigen/LU>

namespace lumitexel {
namespace {

struct Distorted {
  Eigen::Vector2d point;
  Eigen::Matrix2d jacobian;  // of the distorted by the undistorted point
};

Distorted distort(const CameraModel& camera, const Eigen::Vector2d& q) {
  const double x = q.x(), y = q.y(), r2 = q.squaredNorm();
  const double radial = 1.0 + r2 * (camera.k1 + r2 * camera.k2);
  const double radial_slope = 2.0 * (camera.k1 + 2.0 * r2 * camera.k2);  // d radial / d(x or y), over x or y
  Distorted result;
  result.point = {x * radial + 2.0 * camera.p1 * x * y + camera.p2 * (r2 + 2.0 * x * x),
                  y * radial + camera.p1 * (r2 + 2.0 * y * y) + 2.0 * camera.p2 * x * y};
  const double mixed = x * y * radial_slope + 2.0 * camera.p1 * x + 2.0 * camera.p2 * y;
  result.jacobian << radial + x * x * radial_slope + 2.0 * camera.p1 * y + 6.0 * camera.p2 * x, mixed, mixed,
      radial + y * y * radial_slope + 6.0 * camera.p1 * y + 2.0 * camera.p2 * x;
  return result;
}

}  // namespace

Eigen::Vector2d CameraModel::project(const Eigen::Vector3d& x_in_camera) const {
  const Eigen::Vector2d point = distort(*this, x_in_camera.head<2>() / x_in_camera.z()).point;
  return {focal_x_px * point.x() + principal_x_px, focal_y_px * point.y() + principal_y_px};
}

Eigen::Vector3d CameraModel::unproject(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d target{(pixel.x() - principal_x_px) / focal_x_px, (pixel.y() - principal_y_px) / focal_y_px};
  Eigen::Vector2d q = target;
  constexpr int kMaxIterations = 20;
  for (int i = 0; i < kMaxIterations; ++i) {
    const Distorted now = distort(*this, q);
    if (now.jacobian.determinant() <= 0.0) break;  // folded over
    const Eigen::Vector2d step = now.jacobian.inverse() * (target - now.point);
    q += step;
    if (step.squaredNorm() < 1e-28) break;  // 1e-14 of a focal length, far below any pixel
  }
  return q.homogeneous().normalized();
}

}  // namespace lumitexel
