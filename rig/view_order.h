// In which order to visit the views: a short way round, not necessarily the shortest.
#pragma once

#include <cstddef>
#include <vector>

#include "rig/motion_time.h"

namespace lumitexel {

// A permutation of 0..positions.size()-1 with low total sequential_motion_s, beginning from all axes at zero: always
// the nearest next, then improved by reversing stretches (2-opt) until none helps. Same input, same order.
std::vector<std::size_t> short_order(const std::vector<RigPosition>& positions, const RigDescription& rig);

}  // namespace lumitexel
