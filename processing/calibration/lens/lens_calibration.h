// Focal lengths, principal point and distortion from photographs of a flat board in many placements.
//
// The start is Zhang's ("A flexible new technique for camera calibration", 2000): a homography for each board. Then
// weighted least squares over lens and placements (Ceres), each point with its own covariance. Boards that do not fit
// are rejected and listed; distortion terms stay only if the data ask for them (lens_information.h).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "processing/calibration/lens/lens_coverage.h"
#include "processing/calibration/lens/lens_prior.h"
#include "processing/calibration/lens/reprojection.h"

namespace lumitexel {

struct BoardFit {
  std::string name;
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
  double rms_px = 0;  // root mean square distance of its points, both axes together
  double reduced_chi2 = 0;
  std::string rejected;  // why; empty: used
};

struct LensCalibration {
  std::string refusal;  // why there is no calibration, and what to do; empty: there is one
  CameraModel camera;
  LensMatrix covariance = LensMatrix::Zero();  // order of LensVector; zero for terms that are not used
  LensMask terms{};                            // the parameters that were fitted
  std::vector<BoardFit> boards;                // as given
  double rms_px = 0;                           // over the points of all used boards, as BoardFit::rms_px
  double reduced_chi2 = 0;                     // about 1 if the corners are as good as they say and the model holds
  LensCoverage coverage;                       // of the used boards
  std::vector<std::string> warnings;
  bool usable() const { return refusal.empty(); }
};

// A board is rejected if it has fewer than 6 points, or they lie on a line; or if, after the fit, its reduced chi
// square is over 1 with less than one chance in a million and more than 9 times (3 times the RMS) the median's of all
// boards. Rejected boards are tried again with the final camera. Refused: fewer than 2 boards left, or a focal length
// known to no better than 2 %, which is what boards all parallel to the picture give. From 3 boards on everything else
// is a matter of the stated sigmas. Throws BadInput on a picture without size or a landmark whose covariance is not
// positive or whose values are not finite.
//
// With a prior, boards and prior are one least squares (lens_combination.h), from the prior's camera on: all terms take part, those
// that the boards do not determine stay where the prior has them, and the covariance is that of both.
LensCalibration calibrate_lens(int width_px, int height_px, const std::vector<BoardSighting>& sightings,
                               const std::optional<LensPrior>& prior = {});

}  // namespace lumitexel
