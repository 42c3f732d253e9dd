// Where the spheres' ring-flash highlights are: the same in all views, since the spheres stand still.
#pragma once

#include <functional>
#include <vector>

#include "processing/calibration/light/highlight_shots.h"
#include "processing/calibration/light/sphere_line.h"
#include "rig/rig_description.h"

namespace lumitexel {

struct RingRow {
  std::vector<HighlightPixel> rings;  // ascending in their place along the line
  SphereLine line;                    // from them alone
};

// Pooled over all views (median; a view in which the row is not found or stands elsewhere does not count). If no view shows
// all of the rig's spheres, then those that are seen: the row in which most highlights fit a line of spheres to a fifth of a
// pixel, preferring one that recurs in the views. Its places count from the first one seen. Throws Error if fewer than least_of_row(count) are
// seen, or so few that it cannot be
// told which of the spheres they are.
RingRow read_ring_row(std::size_t views, const PictureOf& picture, const CameraModel& camera,
                      const RigDescription& rig, const std::function<void()>& step);

}  // namespace lumitexel
