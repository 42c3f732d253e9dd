// The white squares of a calibration board as samples of how a lamp lights a plane.
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "processing/calibration/lens/camera_model.h"
#include "processing/image/hdr_merge.h"
#include "rig/rig_description.h"

namespace lumitexel {

struct WhitePatch {
  Eigen::Vector3d position_in_camera = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_in_camera = -Eigen::Vector3d::UnitZ();  // unit, towards the camera
  double radiance = 0, variance = 0;  // of a mosaic its green pixels; the mean over the middle half of a square
};

// Of a checkerboard whose pose is known: those squares of the two colours that are the brighter ones, as far as they are
// in the picture and have unflagged pixels. Which corner the pattern is counted from does not matter. Empty for a grid of tags.
std::vector<WhitePatch> white_patches(const MosaicRadiance& image, const CameraModel& camera,
                                      const Eigen::Isometry3d& camera_from_board, const BoardDescription& board);

}  // namespace lumitexel
