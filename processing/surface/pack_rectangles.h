// Rectangles side by side in an atlas, as small as greedy packing makes it.
#pragma once

#include <vector>

namespace lumitexel {

struct PackedRectangle {
  int width = 0, height = 0;  // given
  int x = 0, y = 0;           // found
};

struct PackedSize {
  int width = 0, height = 0;
};

// Square, then cut off where rows stay empty; at least `smallest` wide. The edge grows in steps of a fifth until all fit. Throws Error if that is
// more than `largest`.
PackedSize pack_rectangles(std::vector<PackedRectangle>& rectangles, int smallest, int largest);

}  // namespace lumitexel
