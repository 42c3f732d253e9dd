#include "processing/surface/triangle_adjacency.h"

#include <algorithm>

namespace lumitexel {
namespace {

struct HalfEdge {
  std::uint32_t low, high;  // vertices
  std::uint32_t triangle;
  std::uint32_t side;
};

}  // namespace

std::vector<std::array<std::uint32_t, 3>> triangle_adjacency(const Mesh& mesh) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::uint32_t side = 0; side < 3; ++side) {
      const std::uint32_t a = mesh.triangles[t][side], b = mesh.triangles[t][(side + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, side});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
  });
  std::vector<std::array<std::uint32_t, 3>> neighbours(mesh.triangles.size(),
                                                       {kNoNeighbour, kNoNeighbour, kNoNeighbour});
  for (std::size_t i = 0; i + 1 < edges.size(); ++i) {
    const HalfEdge &a = edges[i], &b = edges[i + 1];
    if (a.low != b.low || a.high != b.high) continue;
    neighbours[a.triangle][a.side] = b.triangle;
    neighbours[b.triangle][b.side] = a.triangle;
  }
  return neighbours;
}

}  // namespace lumitexel
