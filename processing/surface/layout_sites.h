// Where the texels of a texture layout lie on the mesh: the same map that whoever looks a texture coordinate up uses.
//
// Texel (x, y) has its centre at u = (x + 0.5) / width, v = 1 - (y + 0.5) / height.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "processing/surface/mesh.h"

namespace lumitexel {

struct LayoutSite {
  std::uint32_t texel = 0;     // y * width + x
  std::uint32_t triangle = 0;
  double u = 0, v = 0;         // barycentric weights of its second and third vertex
};

struct LayoutSites {
  std::vector<LayoutSite> sites;  // in order of texel, each texel once
  std::size_t contested = 0;      // texels whose centre lies well inside the images of two triangles or more; the first has it
};

// Vertex in texels: a whole and a half is a texel's centre.
Eigen::Vector2d texel_of_vertex(const Mesh& mesh, std::uint32_t vertex, int width, int height);

// The texels whose centre lies in a triangle's image. wanted: one entry a triangle, zero for those left out; empty: all. Triangles
// whose image has no area hold none. The mesh needs texture coordinates.
LayoutSites layout_sites(const Mesh& mesh, int width, int height, const std::vector<std::uint8_t>& wanted = {});

// Calls visit(triangle, texel) for every texel that a bilinear look-up somewhere in a wanted triangle reads.
void each_texel_read(const Mesh& mesh, int width, int height, const std::vector<std::uint8_t>& wanted,
                     const std::function<void(std::uint32_t triangle, std::uint32_t texel)>& visit);

}  // namespace lumitexel
