// Where dark things end before a bright panel, to a small part of a pixel.
//
// An edge that is nearly upright is measured once per pixel row, any other once per column: with the local levels of the
// dark and the bright side, the sum of a row's values across the edge says how much of the row is dark, and so where the edge
// is, whatever the lens's blur, as long as it is even and stays within the window. (A pixel is the mean over its area;
// interpolating between pixels would pull an oblique edge about.) A mosaic's colours are first divided by the panel's
// level in each, so every pixel takes part.
//
// All contours are returned, of the object, of other dark things and the panel's own rim: which of them belong to the
// object, the registration finds out.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "processing/image/hdr_merge.h"
#include "processing/image/radiance_image.h"

namespace lumitexel {

struct ContourPoint {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  Eigen::Vector2d normal = Eigen::Vector2d::UnitX();  // unit, from dark to bright; good to some degrees
  double sigma_px = 0;                                // along the normal, from the pixels' variances
};

struct SilhouetteContour {
  int width_px = 0, height_px = 0;
  std::vector<ContourPoint> points;  // some one per pixel of length, in no order; empty if there is no bright panel
  double saturated = 0;              // share of the edges found that were given up because their pixels are clipped
};

// A merged backlight shot. At least 32 x 32 pixels, else BadInput; so for values that are not finite.
SilhouetteContour silhouette_contour(const MosaicRadiance& backlit);
// The same from any radiance image; channels are averaged.
SilhouetteContour silhouette_contour(const RadianceImage& backlit);
// The rim of a mask (1 = object; width * height bytes): good to 0.3 px, the mask's own grain.
SilhouetteContour contour_of_mask(const std::vector<std::uint8_t>& inside, int width_px, int height_px);

}  // namespace lumitexel
