// A photograph at a coarser scale, as a sensor of larger pixels would have taken it.
#pragma once

#include "processing/image/radiance_image.h"

namespace lumitexel {

// Blocks of `block` by `block` pixels (at least 1) become one: the mean radiance, and its variance with the pixels' errors taken as independent.
// A block is unusable for every reason that one of its pixels is, and dark if all are. Rows and columns that fill no block are cut off; a
// photograph smaller than a block throws std::invalid_argument.
RadianceImage binned(const RadianceImage& image, int block);

}  // namespace lumitexel
