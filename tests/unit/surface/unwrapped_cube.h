// A cube of two triangles a face, each face a square of the texture.
#pragma once

#include "processing/surface/mesh.h"

namespace lumitexel {

// Around the origin. Faces lie in a grid of 3 x 2 cells of [0, 1]^2, each inset by `gutter` on all sides; 0: they touch.
Mesh unwrapped_cube(double side_m, double gutter);

}  // namespace lumitexel
