// The centre of one highlight, to a small part of a pixel.
//
// A highlight on a sphere is a few pixels wide, and a mosaic samples it at a quarter (red, blue) or half (green) of
// them, so a centroid would follow the mosaic. Instead a peak of elliptical shape,
//   background + amplitude * balance[c] / (1 + |L (p - centre)|^2)^2
// (the profile of a slightly rough mirror; L lower triangular), averaged over each pixel's area, is fitted by weighted
// least squares. Saturated and defective pixels are left out, so a clipped core is found by its flanks.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "processing/image/hdr_merge.h"

namespace lumitexel {

using ColourBalance = std::array<double, 3>;  // a lamp's response per mosaic colour, relative to green (mono: unused)

struct FittedHighlight {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double sigma_px = 0;    // per axis, from the fit's covariance scaled by its residuals
  double amplitude = 0;   // of green or mono, in the image's unit
  ColourBalance balance{1, 1, 1};
  double width_px = 0;    // 1 / sqrt(det L): a scale radius
};

// Fits within `reach_px` around `start`. Without a balance the three amplitudes are free (mosaics only). None if too few
// usable pixels are there, the fit does not converge, or it ends outside the window or wider than it.
std::optional<FittedHighlight> fit_highlight(const MosaicRadiance& image, const Eigen::Vector2d& start, int reach_px,
                                             const std::optional<ColourBalance>& balance);

}  // namespace lumitexel
