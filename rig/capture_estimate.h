// What a capture will cost, before anything moves.
#pragma once

#include <cstdint>
#include <vector>

#include "rig/rig_description.h"
#include "rig/shot.h"

namespace lumitexel {

struct CaptureEstimate {
  double exposure_s = 0, readout_s = 0;
  double motion_s = 0;       // travel and settling, one axis after the other, from all axes at zero
  double estimate_s = 0;     // exposure_s + readout_s + motion_s; lamps are taken to switch at once
  double lower_bound_s = 0;  // exposure_s + readout_s + shortest_motion_s
  // The weight of the minimum spanning tree over the positions, with the time of the slowest axis at full speed as
  // distance and no settling: every order of visiting is a spanning tree, so none can be faster.
  double shortest_motion_s = 0;
  std::int64_t bytes = 0;  // of all frames on disk
};

CaptureEstimate estimate_capture(const std::vector<Shot>& shots, const RigDescription& rig);

}  // namespace lumitexel
