#include "processing/surface/mesh.h"

#include <Eigen/Geometry>

namespace lumitexel {

std::vector<Eigen::Vector3d> vertex_normals(const Mesh& mesh) {
  std::vector<Eigen::Vector3d> normals(mesh.positions.size(), Eigen::Vector3d::Zero());
  for (const auto& [a, b, c] : mesh.triangles) {
    const Eigen::Vector3d& origin = mesh.positions[a];
    const Eigen::Vector3d twice_area = (mesh.positions[b] - origin).cross(mesh.positions[c] - origin);
    for (const std::uint32_t vertex : {a, b, c}) normals[vertex] += twice_area;
  }
  for (Eigen::Vector3d& normal : normals) {
    const double length = normal.norm();
    normal = length > 0.0 ? Eigen::Vector3d(normal / length) : Eigen::Vector3d::UnitZ();
  }
  return normals;
}

}  // namespace lumitexel
