// What a lens's covariance means in the picture.
#pragma once

#include "processing/calibration/lens/reprojection.h"

namespace lumitexel {

// Standard deviation of where the lens puts the direction that it now puts at `pixel`: root of the sum over x and y.
double lens_sigma_px(const CameraModel& camera, const LensMatrix& covariance, const Eigen::Vector2d& pixel);

// The largest over the picture's four corners.
double corner_sigma_px(const CameraModel& camera, const LensMatrix& covariance);

}  // namespace lumitexel
