// A sheet of shaded spheres: each material's truth and, to the right of it, its fit.
#pragma once

#include <utility>
#include <vector>

#include "processing/brdf/nearest_material.h"
#include "processing/image/image.h"

namespace lumitexel {

// (truth, fit) pairs, `columns` a row; spheres of `size_px`, under a light from the upper left and a fainter one from behind the right edge. Each pair
// has its own exposure. sRGB, in [0, 1].
Image sphere_sheet(const std::vector<std::pair<BrdfValues, BrdfValues>>& pairs, int columns, int size_px);

}  // namespace lumitexel
