// The camera's eight lens parameters as a vector, for least squares over them and for their covariance.
#pragma once

#include <Eigen/Core>

#include "processing/calibration/lens/camera_model.h"

namespace lumitexel {

inline constexpr int kLensParameters = 8;
using LensVector = Eigen::Matrix<double, kLensParameters, 1>;  // focal x, y, principal x, y (px), k1, k2, p1, p2
using LensMatrix = Eigen::Matrix<double, kLensParameters, kLensParameters>;

LensVector lens_vector(const CameraModel& camera);
CameraModel with_lens_vector(CameraModel camera, const LensVector& lens);

// What a covariance says beforehand. A parameter with no variance is one that its calibration did not use: it is held
// where it is, by a sigma that no picture notices (1e-4 px at the rim), so that the matrix stays regular.
LensMatrix lens_prior_information(const LensMatrix& covariance);

}  // namespace lumitexel
