// Where a texel that knows nothing takes its value from.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lumitexel {

// For every texel, row by row, the nearest that is known (breadth first, over edges; `known` nonzero): itself where it is, and where none is.
std::vector<std::size_t> nearest_known_texel(int width, int height, const std::vector<std::uint8_t>& known);

}  // namespace lumitexel
