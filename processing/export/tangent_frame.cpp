#include "processing/export/tangent_frame.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

Eigen::Vector3d in_plane(const Eigen::Vector3d& vector, const Eigen::Vector3d& normal) { return vector - vector.dot(normal) * normal; }

// Twice the triangle's area in the texture, negative where it lies mirrored.
double texture_area(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const Eigen::Vector2d st1 = mesh.texcoords[b] - mesh.texcoords[a], st2 = mesh.texcoords[c] - mesh.texcoords[a];
  return st1.x() * st2.y() - st1.y() * st2.x();
}

// The direction, of any length.
Eigen::Vector3d growing_u(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle) {
  const auto& [a, b, c] = triangle;
  const double t1 = mesh.texcoords[b].y() - mesh.texcoords[a].y(), t2 = mesh.texcoords[c].y() - mesh.texcoords[a].y();
  const Eigen::Vector3d along = t2 * (mesh.positions[b] - mesh.positions[a]) - t1 * (mesh.positions[c] - mesh.positions[a]);
  return texture_area(mesh, triangle) < 0.0 ? Eigen::Vector3d(-along) : along;
}

Eigen::Vector3d interpolated_normal(const Mesh& mesh, std::uint32_t triangle, double u, double v) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  return ((1.0 - u - v) * mesh.normals[a] + u * mesh.normals[b] + v * mesh.normals[c]).normalized();
}

struct Sums {
  Eigen::Vector3d tangent = Eigen::Vector3d::Zero();
  double handedness = 0;
};

// Corner k of the triangle, its share of the vertex's tangent.
void add_corner(const Mesh& mesh, const std::array<std::uint32_t, 3>& triangle, std::size_t k, const Eigen::Vector3d& along_u,
                double handedness, Sums& sums) {
  const std::uint32_t vertex = triangle[k];
  const Eigen::Vector3d normal = mesh.normals[vertex].normalized();
  const auto side = [&](std::size_t other) { return in_plane(mesh.positions[triangle[other % 3]] - mesh.positions[vertex], normal).normalized(); };
  const double angle = std::acos(std::clamp(side(k + 1).dot(side(k + 2)), -1.0, 1.0));
  sums.tangent += angle * in_plane(along_u, normal).normalized();
  sums.handedness += angle * handedness;
}

}  // namespace

std::vector<Eigen::Vector4d> vertex_tangents(const Mesh& mesh) {
  std::vector<Sums> sums(mesh.positions.size());
  for (const auto& triangle : mesh.triangles) {
    const double area = texture_area(mesh, triangle);
    if (area == 0.0) continue;
    const Eigen::Vector3d along_u = growing_u(mesh, triangle);
    for (std::size_t k = 0; k < 3; ++k) add_corner(mesh, triangle, k, along_u, area > 0.0 ? 1.0 : -1.0, sums[triangle[k]]);
  }
  std::vector<Eigen::Vector4d> tangents;
  for (std::size_t v = 0; v < sums.size(); ++v) {
    const Eigen::Vector3d normal = mesh.normals[v].normalized();
    Eigen::Vector3d tangent = in_plane(sums[v].tangent, normal);
    // No area in the texture, or directions that cancel: any will do.
    if (!(tangent.norm() > 1e-9)) tangent = normal.unitOrthogonal();
    tangent.normalize();
    tangents.emplace_back(tangent.x(), tangent.y(), tangent.z(), sums[v].handedness < 0.0 ? -1.0 : 1.0);
  }
  return tangents;
}

Eigen::Matrix3d tangent_frame(const Mesh& mesh, const std::vector<Eigen::Vector4d>& tangents, std::uint32_t triangle, double u, double v) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const double first = 1.0 - u - v;
  const Eigen::Vector3d normal = interpolated_normal(mesh, triangle, u, v);
  Eigen::Vector3d tangent = first * tangents[a].head<3>() + u * tangents[b].head<3>() + v * tangents[c].head<3>();
  if (!(in_plane(tangent, normal).norm() > 1e-6)) tangent = normal.unitOrthogonal();
  tangent.normalize();
  Eigen::Matrix3d frame;
  frame << tangent, tangents[a].w() * normal.cross(tangent), normal;
  return frame;
}

Eigen::Matrix3d triangle_frame(const Mesh& mesh, std::uint32_t triangle, double u, double v) {
  const Eigen::Vector3d normal = interpolated_normal(mesh, triangle, u, v);
  Eigen::Vector3d tangent = in_plane(growing_u(mesh, mesh.triangles[triangle]).normalized(), normal);
  if (!(tangent.norm() > 1e-6)) tangent = normal.unitOrthogonal();
  tangent.normalize();
  Eigen::Matrix3d frame;
  frame << tangent, normal.cross(tangent), normal;
  return frame;
}

Eigen::Vector3d in_frame(const Eigen::Matrix3d& frame, const Eigen::Vector3d& normal_in_world) {
  Eigen::Vector3d normal = (frame.inverse() * normal_in_world).normalized();
  normal.z() = std::max(normal.z(), 0.0);
  return normal.isZero() ? Eigen::Vector3d::UnitZ() : normal.normalized();
}

}  // namespace lumitexel
