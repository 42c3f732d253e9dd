#include "processing/calibration/lens/lens_sigma.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {

double lens_sigma_px(const CameraModel& camera, const LensMatrix& covariance, const Eigen::Vector2d& pixel) {
  const Eigen::Vector3d ray = camera.unproject(pixel);
  const double u = ray.x() / ray.z(), v = ray.y() / ray.z(), r2 = u * u + v * v;
  const double fx = camera.focal_x_px, fy = camera.focal_y_px;
  Eigen::Matrix<double, 2, kLensParameters> slope;
  slope << (pixel.x() - camera.principal_x_px) / fx, 0, 1, 0, fx * u * r2, fx * u * r2 * r2, fx * 2 * u * v, fx * (r2 + 2 * u * u),
      0, (pixel.y() - camera.principal_y_px) / fy, 0, 1, fy * v * r2, fy * v * r2 * r2, fy * (r2 + 2 * v * v), fy * 2 * u * v;
  return std::sqrt(std::max(0.0, (slope * covariance * slope.transpose()).trace()));
}

double corner_sigma_px(const CameraModel& camera, const LensMatrix& covariance) {
  double largest = 0.0;
  for (const double x : {0.0, 1.0}) {
    for (const double y : {0.0, 1.0})
      largest = std::max(largest, lens_sigma_px(camera, covariance, {x * camera.width_px, y * camera.height_px}));
  }
  return largest;
}

}  // namespace lumitexel
