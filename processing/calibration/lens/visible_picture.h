// A photograph as 8-bit gray, for detectors that were made for such.
#pragma once

#include <cstdint>
#include <vector>

#include "processing/image/hdr_merge.h"

namespace lumitexel {

struct GrayPicture {
  int width = 0, height = 0;
  std::vector<std::uint8_t> data;  // row-major
};

// Green interpolated to every pixel, then asinh(value / floor), scaled to 0 … 255. The curve is logarithmic where there
// is light, so that a pattern in shade next to a highlight ten thousand times as bright keeps its contrast, and linear
// below the floor, where there is only noise. The floor is 16 standard deviations of the darkest tenth, at least 1e-4
// of the brightest. Only for finding: edges move by tenths of a pixel under such a curve, so places are measured in the
// radiance itself.
GrayPicture visible_picture(const MosaicRadiance& image);

}  // namespace lumitexel
