// Texture coordinates that a file gives to the corners of faces rather than to vertices.
#pragma once

#include <array>
#include <vector>

#include "processing/surface/mesh_check.h"

namespace lumitexel {

using WedgeTexcoords = std::vector<std::array<Eigen::Vector2d, 3>>;  // of every triangle's corners; NaN where there are none

// Makes one vertex of every pair of vertex and texture coordinate that a corner has, in order of first use; vertices that no triangle uses
// come last, at (0, 0). Does nothing unless every corner has a texture coordinate: a map with holes is of no use to anyone who samples it.
// parsed: one position a vertex, as in its file; corners may be out of range, see check_mesh, and then nothing is done either.
void split_wedges(const WedgeTexcoords& wedges, ParsedMesh& parsed);

}  // namespace lumitexel
