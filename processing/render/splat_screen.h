// Splats drawn over one another: first the depths of those that hide, then the light of those that are not hidden.
#pragma once

#include <vector>

#include "processing/render/splat.h"
#include "processing/render/splat_kernel.h"

namespace lumitexel {

// Fills radiance and hit, which have the view's size, and adds to shown. In bands of rows, each drawn by one thread in
// the order of the splats.
void draw_splats(const View& view, const std::vector<Splat>& splats, SplatView& result);

}  // namespace lumitexel
