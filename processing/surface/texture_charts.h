// Charts of a texture layout: triangles that share vertices, each of which is a position and a texture coordinate.
#pragma once

#include <cstdint>
#include <vector>

#include "processing/surface/mesh.h"

namespace lumitexel {

// Of every triangle the number of its chart, from 0 in order of first triangle.
std::vector<std::uint32_t> chart_of_triangle(const Mesh& mesh);

}  // namespace lumitexel
