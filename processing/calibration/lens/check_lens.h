// Does yesterday's lens calibration still hold? A photograph or two of the board decide.
//
// The camera is held, each board's pose is free. What the pose cannot explain is looked at in the at most 8 directions
// in which a change of the lens would show: u = U^T r, from the singular value decomposition J = U S V^T of the
// pose-free residuals' slope by the lens. Unchanged, u has covariance 1 + S V^T C V S, C the calibration's own, and u^T
// (…)^-1 u is chi square. What is left of the residuals says whether the board itself is in order; if it scatters more
// than stated, that is the unit.
#pragma once

#include <string>
#include <vector>

#include "processing/calibration/lens/reprojection.h"

namespace lumitexel {

enum class LensVerdict {
  Holds,
  Changed,
  Unclear,  // the boards cannot tell: too few points, or they do not fit any lens (bent, moved, misread)
};
const char* to_string(LensVerdict verdict);  // "holds", "changed", "unclear"

struct LensCheck {
  LensVerdict verdict = LensVerdict::Unclear;
  double chi2 = 0, degrees = 0;   // of the test
  double bound = 0;               // above it: changed
  double board_reduced_chi2 = 0;  // of the rest of the residuals
  double rms_px = 0;              // with the lens as calibrated
  // The least changes that this check would notice 19 times in 20: of both focal lengths, in parts; of the principal
  // point. A single board parallel to the picture notices no change of focal length at all.
  double detectable_focal = 0, detectable_principal_px = 0;
  std::string reason;  // a sentence
};

// Says "changed" of an unchanged lens once in a hundred checks. Throws BadInput if the covariance is not finite.
LensCheck check_lens(const CameraModel& camera, const LensMatrix& covariance,
                     const std::vector<BoardSighting>& sightings);

}  // namespace lumitexel
