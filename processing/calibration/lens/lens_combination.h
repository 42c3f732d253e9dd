// Boards and the rig's description of the lens in one least squares: what the boards determine comes from them, the rest stays
// with the description, and the covariance says how well each is known.
#pragma once

#include <vector>

#include "processing/calibration/lens/lens_prior.h"
#include "processing/calibration/lens/reprojection.h"

namespace lumitexel {

LensPull pull_of(const LensPrior& prior, double unit_chi2 = 1.0);

struct CombinedLens {
  bool converged = false;
  LensMatrix covariance = LensMatrix::Zero();  // of the camera, positive definite
  // By how much the description's sigmas had to be widened because the boards contradict it (one chance in a million that
  // such a difference is chance); 1: they do not.
  double widened = 1.0;
};

// Changes camera and placements from a start near the solution. The boards' unit of noise is their own reduced chi square where
// that is above 1.
CombinedLens combine_with_prior(CameraModel& camera, std::vector<PlacedBoard>& boards, const LensPrior& prior);

}  // namespace lumitexel
