// Which triangles share an edge.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "processing/surface/mesh.h"

namespace lumitexel {

inline constexpr std::uint32_t kNoNeighbour = 0xffffffffu;

// For every triangle its neighbours across the edges (0,1), (1,2), (2,0); kNoNeighbour at a border. Edges are matched
// by vertex index, for meshes with at most two triangles an edge.
std::vector<std::array<std::uint32_t, 3>> triangle_adjacency(const Mesh& mesh);

}  // namespace lumitexel
