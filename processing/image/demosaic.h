// Colour at every pixel of a mosaic, by the mean of the nearest pixels of each colour.
//
// Exact where the radiance is linear across the picture. Variances are propagated as if the samples were independent,
// which they are; the results of neighbouring pixels share samples and are not.
//
// Flags: a defective sample is left out where another one of its colour is near (its own pixel is filled in from them);
// a saturated sample marks every pixel that would use it, because leaving it out would darken a highlight's edge; a
// pixel is dark only if all of its samples are.
#pragma once

#include "processing/image/hdr_merge.h"
#include "processing/image/radiance_image.h"

namespace lumitexel {

// Three channels R, G, B at full resolution; a mono image passes through with one channel. At least 2x2 pixels.
RadianceImage demosaic(const MosaicRadiance& mosaic);

}  // namespace lumitexel
