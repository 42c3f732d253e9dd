// A triangle mesh in metres.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

namespace lumitexel {

struct Mesh {
  std::vector<Eigen::Vector3d> positions;
  std::vector<Eigen::Vector3d> normals;    // one unit normal a vertex; never empty once read
  std::vector<Eigen::Vector2d> texcoords;  // one a vertex in [0, 1], v up; empty if the mesh has none
  std::vector<std::array<std::uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

// Area-weighted vertex normals; a vertex that no triangle with area touches gets +z.
std::vector<Eigen::Vector3d> vertex_normals(const Mesh& mesh);

}  // namespace lumitexel
