// What is known of a lens before any board was photographed: the rig's description, and how far off it may be.
#pragma once

#include "processing/calibration/lens/reprojection.h"
#include "rig/rig_description.h"

namespace lumitexel {

struct LensPrior {
  CameraModel camera;
  LensMatrix covariance = LensMatrix::Zero();  // order of LensVector; positive definite
};

// From LensDescription's sigmas. Both focal lengths are off together, their ratio by a thousandth: pixels are square to that.
// k1 and k2 each move the farthest corner by distortion_sigma_px; p1 and p2, which come from lenses mounted askew, by a fifth
// of it. A term that bends the picture's corners moves its middle by little: where boards were in the middle alone it stays
// with the description. Throws BadInput unless the sigmas and focal lengths are positive.
LensPrior lens_prior_of(const CameraDescription& camera);

}  // namespace lumitexel
