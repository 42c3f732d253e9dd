// A sphere tessellated without poles.
#pragma once

#include "processing/surface/mesh.h"

namespace lumitexel {

// Unit sphere of 12 * cells^2 nearly equal triangles: a cube's faces in cells x cells squares of equal angle.
Mesh cube_sphere(int cells);

}  // namespace lumitexel
