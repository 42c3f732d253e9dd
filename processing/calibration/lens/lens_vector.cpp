#include "processing/calibration/lens/lens_vector.h"

#include <Eigen/Cholesky>

namespace lumitexel {

LensVector lens_vector(const CameraModel& c) {
  LensVector lens;
  lens << c.focal_x_px, c.focal_y_px, c.principal_x_px, c.principal_y_px, c.k1, c.k2, c.p1, c.p2;
  return lens;
}

CameraModel with_lens_vector(CameraModel camera, const LensVector& lens) {
  camera.focal_x_px = lens[0], camera.focal_y_px = lens[1];
  camera.principal_x_px = lens[2], camera.principal_y_px = lens[3];
  camera.k1 = lens[4], camera.k2 = lens[5], camera.p1 = lens[6], camera.p2 = lens[7];
  return camera;
}

LensMatrix lens_prior_information(const LensMatrix& covariance) {
  constexpr double kHeld_px = 1e-4, kHeld = 1e-7;  // a picture's rim has r of some 0.2, and a focal length 10^4 px
  LensMatrix regular = covariance;
  for (int i = 0; i < kLensParameters; ++i) {
    const double held = i < 4 ? kHeld_px : kHeld;
    if (covariance(i, i) < held * held) regular(i, i) = held * held;
  }
  const LensVector scale = regular.diagonal().cwiseSqrt().cwiseInverse();
  const LensMatrix unit = scale.asDiagonal() * regular * scale.asDiagonal();
  return scale.asDiagonal() * unit.ldlt().solve(LensMatrix::Identity()) * scale.asDiagonal();
}

}  // namespace lumitexel
