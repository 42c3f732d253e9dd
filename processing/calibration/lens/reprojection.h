// Boards re-projected through a camera: the residuals of the lens calibration, their linearisation and their least
// squares.
//
// A landmark's residual is L^-1 (predicted - seen), L L^T its covariance: unit variance where the stated noise is true.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/lens/landmark.h"
#include "processing/calibration/lens/lens_vector.h"

namespace lumitexel {

using LensMask = std::array<bool, kLensParameters>;

struct PlacedBoard {
  BoardSighting sighting;
  Eigen::Isometry3d camera_from_board = Eigen::Isometry3d::Identity();
};

// What is held against the lens besides the boards: (lens - mean)^T information (lens - mean) is added to their chi square.
struct LensPull {
  LensVector mean = LensVector::Zero();
  LensMatrix information = LensMatrix::Zero();
};

// Least squares over the camera's free parameters and all placements, which are changed in place. Landmarks beyond
// the 99.9 % bound of chi square weigh less (Huber). Returns whether it converged.
bool refine_boards(CameraModel& camera, const LensMask& free, std::vector<PlacedBoard>& boards,
                   const std::optional<LensPull>& pull = {});

// The whitened residuals and their slope with respect to the lens, both freed of what the board's pose can explain (the
// 6 directions of the pose are projected out): so many rows as residuals less 6.
struct PoseFreeResiduals {
  Eigen::VectorXd residual;
  Eigen::Matrix<double, Eigen::Dynamic, kLensParameters> slope;
};
PoseFreeResiduals pose_free_residuals(const CameraModel& camera, const PlacedBoard& board);

struct BoardMisfit {
  double rms_px = 0;          // root mean square of the distances, both axes together
  double chi2 = 0;            // of the whitened residuals, with no robust weights
  double worst_landmark = 0;  // largest whitened distance of a landmark, over the 99.9 % bound
};
// Infinite if a point lies behind the camera.
BoardMisfit board_misfit(const CameraModel& camera, const PlacedBoard& board);

}  // namespace lumitexel
