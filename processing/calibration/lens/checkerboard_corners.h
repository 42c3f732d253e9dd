// One inner corner of a checkerboard, measured in the linear radiance; see board_detection.h for the model.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "processing/image/hdr_merge.h"

namespace lumitexel {

struct CheckerCorner {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Matrix2d covariance_px2 = Eigen::Matrix2d::Zero();
  double reduced_chi2 = 0;
};

// start: within 2 pixels; along_columns, along_rows: towards the next corners, in pixels. None if the patch leaves the
// picture, is saturated, or does not look like a corner.
std::optional<CheckerCorner> measure_checker_corner(const MosaicRadiance& image, const Eigen::Vector2d& start,
                                                    const Eigen::Vector2d& along_columns,
                                                    const Eigen::Vector2d& along_rows);

}  // namespace lumitexel
