// Linear radiance made visible on a screen.
#pragma once

#include "processing/image/image.h"

namespace lumitexel {

// The sRGB transfer curve (IEC 61966-2-1) of a linear value in [0, 1]; values outside are clipped first, NaN is 0.
float srgb_encoded(float linear);

// radiance / white, clipped, on the sRGB curve: three channels, one channel repeated. The first three channels are
// taken for red, green and blue.
Image tone_mapped(const Image& radiance, double white);

}  // namespace lumitexel
