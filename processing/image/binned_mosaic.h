// A mosaic's radiance at a coarser scale, without its colours.
#pragma once

#include "processing/image/hdr_merge.h"

namespace lumitexel {

// Blocks of `block` by `block` pixels become one of mono: the mean value of all pixels, or of the green ones of a mosaic of colours, its variance
// with their errors taken as independent, and every flag that one of them has. Green alone has its middle in the middle of a block: red and
// blue lie on either side, and by their difference would shift what is seen, by a fiftieth of a block under common lamps.
// block: at least 1, and even for a mosaic of colours (std::invalid_argument otherwise, and where no block fits). Rows and columns that fill
// no block are cut off. 1: the image itself.
MosaicRadiance binned(MosaicRadiance image, int block);

}  // namespace lumitexel
