// How much of an object's surface was measured.
#pragma once

#include "processing/model/model.h"

namespace lumitexel {

// The share of the mesh's area whose texels were fitted to samples of their own, 0 to 1; 0 for a mesh without area. Every
// triangle is asked at the middles of n * n equal parts, n being such that a part is about a texel, at most 32.
double measured_area_share(const Model& model);

}  // namespace lumitexel
