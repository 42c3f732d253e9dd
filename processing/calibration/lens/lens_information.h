// What the residuals of all boards together say about the lens, poses eliminated: which distortion terms they ask for,
// and the covariance of the parameters.
#pragma once

#include <optional>

#include "processing/calibration/lens/reprojection.h"

namespace lumitexel {

struct LensInformation {
  LensMatrix matrix =
      LensMatrix::Zero();  // J^T J of the pose-free residuals: the inverse of the covariance at unit noise
  double chi2 = 0;
  double degrees = 0;  // residuals less 6 for each board (the lens's own parameters are not yet taken off)
};
LensInformation lens_information(const CameraModel& camera, const std::vector<PlacedBoard>& boards);

// The distortion terms among none; k1; k1, k2; and each of these with p1, p2, by the Bayesian information criterion:
// each parameter must lower chi square by ln(degrees). `full` belongs to the fit with all terms free, whose distortion
// is in `lens`; what chi square would be without some follows from its quadratic form. If the reduced chi square is
// above 1, it is the unit.
LensMask chosen_terms(const LensVector& lens, const LensInformation& full);

// Of the free parameters (zero elsewhere), scaled by the reduced chi square if that is above 1. None if they are not
// all determined.
std::optional<LensMatrix> lens_covariance(const LensInformation& information, const LensMask& free);

}  // namespace lumitexel
