#include "processing/calibration/lens/lens_prior.h"

#include <algorithm>
#include <cmath>

#include "drivers/error.h"
#include "processing/calibration/lens/rig_camera.h"

namespace lumitexel {

LensPrior lens_prior_of(const CameraDescription& description) {
  const LensDescription& lens = description.lens;
  if (!(lens.focal_x_px > 0.0 && lens.focal_y_px > 0.0 && lens.focal_sigma_px > 0.0 && lens.principal_sigma_px > 0.0 &&
        lens.distortion_sigma_px > 0.0)) {
    throw BadInput("lens description", "a focal length or sigma that is not positive", "positive ones");
  }
  LensPrior prior{camera_model_of(description), LensMatrix::Zero()};
  const CameraModel& camera = prior.camera;
  constexpr double kSquarePixels = 1e-3, kAskew = 0.2;
  const double common = lens.focal_sigma_px / lens.focal_x_px, ratio = 0.5 * kSquarePixels;
  const Eigen::Vector2d focal(camera.focal_x_px, camera.focal_y_px);
  prior.covariance.topLeftCorner<2, 2>() = common * common * focal * focal.transpose();
  prior.covariance.diagonal().head<2>() += ratio * ratio * focal.cwiseAbs2();
  prior.covariance(2, 2) = prior.covariance(3, 3) = lens.principal_sigma_px * lens.principal_sigma_px;
  const double across_px = std::max(camera.principal_x_px, camera.width_px - camera.principal_x_px),
               down_px = std::max(camera.principal_y_px, camera.height_px - camera.principal_y_px);
  const double r = std::hypot(across_px / camera.focal_x_px, down_px / camera.focal_y_px);
  const double corner = lens.distortion_sigma_px / std::sqrt(camera.focal_x_px * camera.focal_y_px);
  constexpr double kMostOfTangential = 3.0;  // a term p moves a point by up to 3 p r^2
  const double askew = kAskew * corner / (kMostOfTangential * r * r);
  prior.covariance.diagonal().tail<4>() =
      Eigen::Vector4d(corner / std::pow(r, 3), corner / std::pow(r, 5), askew, askew).cwiseAbs2();
  return prior;
}

}  // namespace lumitexel
