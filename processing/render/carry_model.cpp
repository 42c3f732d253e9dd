#include "processing/render/carry_model.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <vector>

#include "drivers/error.h"
#include "processing/render/texel_triangles.h"

namespace lumitexel {
namespace {

// Columns e1, e2 and the normal, as long as the triangle's size wants it.
std::optional<Eigen::Matrix3d> triangle_frame(const Mesh& mesh, std::size_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Eigen::Vector3d first = mesh.positions[b] - mesh.positions[a], second = mesh.positions[c] - mesh.positions[a];
  const Eigen::Vector3d across = first.cross(second);
  const double doubled_area = across.norm();
  if (!(doubled_area > 0.0)) return std::nullopt;
  Eigen::Matrix3d frame;
  frame << first, second, across / doubled_area * std::sqrt(doubled_area);
  return frame;
}

// F^-T of each triangle; nothing for those that stay where they are, whose normals keep their bits.
std::vector<std::optional<Eigen::Matrix3d>> normal_changes(const Mesh& before, const Mesh& after,
                                                           const std::string& where) {
  std::vector<std::optional<Eigen::Matrix3d>> changes(before.triangles.size());
  for (std::size_t t = 0; t < changes.size(); ++t) {
    const auto old_frame = triangle_frame(before, t), new_frame = triangle_frame(after, t);
    if (!new_frame) throw BadInput(where, "triangle " + std::to_string(t) + " has no area", "triangles with an area");
    if (old_frame && *old_frame != *new_frame) changes[t] = (*old_frame * new_frame->inverse()).transpose();
  }
  return changes;
}

// The model's mesh with positions and normals of the changed one, corner by corner.
Mesh moved_mesh(const Mesh& mesh, const Mesh& changed, const std::string& where) {
  if (changed.triangles.size() != mesh.triangles.size()) {
    throw BadInput(where, std::to_string(changed.triangles.size()) + " triangles",
                   std::to_string(mesh.triangles.size()) + ", in the order of the model's mesh");
  }
  Mesh moved = mesh;
  std::vector<bool> placed(mesh.positions.size(), false), mixed(mesh.positions.size(), false);
  std::vector<Eigen::Vector3d> sums(mesh.positions.size(), Eigen::Vector3d::Zero());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[t][k], source = changed.triangles[t][k];
      if (placed[vertex] && moved.positions[vertex] != changed.positions[source]) {
        throw BadInput(
            where, "triangle " + std::to_string(t) + ", corner " + std::to_string(k) + " is torn from its neighbours",
            "the topology of the model's mesh: the same triangles and corners in the same order");
      }
      mixed[vertex] = mixed[vertex] || (placed[vertex] && moved.normals[vertex] != changed.normals[source]);
      if (!placed[vertex]) moved.normals[vertex] = changed.normals[source];
      sums[vertex] += changed.normals[source];
      moved.positions[vertex] = changed.positions[source];
      placed[vertex] = true;
    }
  }
  for (std::size_t v = 0; v < sums.size(); ++v) {  // a vertex that was split along an edge has several
    if (mixed[v] && sums[v].norm() > 0.0) moved.normals[v] = sums[v].normalized();
  }
  return moved;
}

// Texels with a material beside all triangles take the triangle of the nearest texel that has one, ring by ring.
void spread_triangles(const Model& model, std::vector<std::int32_t>& triangle) {
  const auto width = static_cast<std::size_t>(model.width), height = static_cast<std::size_t>(model.height);
  std::vector<std::size_t> rim, next;
  for (std::size_t t = 0; t < triangle.size(); ++t) {
    if (triangle[t] != kNoTriangle) rim.push_back(t);
  }
  for (; !rim.empty(); rim.swap(next), next.clear()) {
    for (const std::size_t from : rim) {
      const std::size_t x = from % width, y = from / width;
      const auto offer = [&](std::size_t to) {
        if (triangle[to] != kNoTriangle || model.material[to] == Model::kNoMaterial) return;
        triangle[to] = triangle[from];
        next.push_back(to);
      };
      if (x > 0) offer(from - 1);
      if (x + 1 < width) offer(from + 1);
      if (y > 0) offer(from - width);
      if (y + 1 < height) offer(from + width);
    }
  }
}

}  // namespace

Model carried_to(Model model, const Mesh& changed, const std::string& where) {
  Mesh moved = moved_mesh(model.mesh, changed, where);
  const std::vector<std::optional<Eigen::Matrix3d>> changes = normal_changes(model.mesh, moved, where);
  std::vector<std::int32_t> triangle = triangle_of_texel(model);
  spread_triangles(model, triangle);
  for (std::size_t t = 0; t < triangle.size(); ++t) {
    float* stored = &model.normal.data[3 * t];
    const Eigen::Vector3d normal(stored[0], stored[1], stored[2]);
    if (triangle[t] == kNoTriangle || normal.isZero()) continue;
    const std::optional<Eigen::Matrix3d>& change = changes[static_cast<std::size_t>(triangle[t])];
    if (!change) continue;
    const Eigen::Vector3d turned = (*change * normal).normalized();
    for (int axis = 0; axis < 3; ++axis) stored[axis] = static_cast<float>(turned[axis]);
  }
  model.mesh = std::move(moved);
  return model;
}

}  // namespace lumitexel
