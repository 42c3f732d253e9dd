// How wide a point's highlight is on every sphere, from those of the ring flash: points at known places about the lens.
#pragma once

#include <functional>
#include <vector>

#include "processing/calibration/light/highlight_shots.h"
#include "processing/calibration/light/sphere_line.h"

namespace lumitexel {

// What the spheres make of a point.
struct PointWidths {
  double exponent = 2;
  std::vector<double> log_square;   // by sphere of the line: log w_k^2 (px^2 in t's plane, fit_highlight); NaN: not known
  double ring_part = 0;             // mean over spheres: the ring's mean square offset across, over w_k^2
};
// views: those of spread_views; rings: where their highlights are.
PointWidths measure_point_widths(std::size_t views, const PictureOf& ring, const CameraModel& camera, const SphereLine& line,
                                 const std::vector<HighlightPixel>& rings, double ring_radius_m);

// At most four of the views for which `usable` says yes, evenly spread: more hardly add, what is left is common to them.
std::vector<std::size_t> spread_views(std::size_t views, const std::function<bool(std::size_t)>& usable);

// Of places in t's plane, along the unit vector u. 0 without any.
double mean_square_along(const Eigen::Vector2d& u, const std::vector<HighlightPeak>& peaks);

}  // namespace lumitexel
