#include "processing/export/moved_model.h"

#include <Eigen/LU>
#include <algorithm>

#include "drivers/error.h"
#include "processing/export/nearest_texel.h"
#include "processing/export/tangent_frame.h"
#include "processing/render/texel_triangles.h"

namespace lumitexel {
namespace {

void check_same_triangles(const Mesh& mesh, const Mesh& moved, const std::string& where) {
  const auto counts = [](const Mesh& m) {
    return std::to_string(m.positions.size()) + " vertices and " + std::to_string(m.triangles.size()) + " triangles";
  };
  if (mesh.positions.size() != moved.positions.size() || mesh.triangles.size() != moved.triangles.size()) {
    throw BadInput(where, counts(moved), "the model's " + counts(mesh) + ", in its order: move the vertices of the model's own mesh.ply");
  }
  const auto [other, own] = std::mismatch(moved.triangles.begin(), moved.triangles.end(), mesh.triangles.begin());
  if (other != moved.triangles.end()) {
    throw BadInput(where + ": triangle " + std::to_string(other - moved.triangles.begin()), "not the model's",
                   "the model's triangles in their order: move the vertices of the model's own mesh.ply");
  }
}

}  // namespace

Model on_moved_mesh(Model model, const Mesh& moved, const std::string& where) {
  if (model.mesh.texcoords.empty()) throw BadInput("model", "a mesh without texture coordinates", "texture coordinates");
  check_same_triangles(model.mesh, moved, where);
  Mesh mesh = model.mesh;
  mesh.positions = moved.positions;
  mesh.normals = moved.normals;
  const std::vector<Eigen::Vector4d> tangents = vertex_tangents(model.mesh), moved_tangents = vertex_tangents(mesh);
  const std::vector<std::int32_t> triangles = triangle_of_texel(model);
  std::vector<std::uint8_t> known(triangles.size());
  std::transform(triangles.begin(), triangles.end(), known.begin(), [](std::int32_t triangle) { return triangle != kNoTriangle ? 1 : 0; });
  const std::vector<std::size_t> source = nearest_known_texel(model.width, model.height, known);
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const Eigen::Vector3d own(model.normal.data[3 * t], model.normal.data[3 * t + 1], model.normal.data[3 * t + 2]);
    if (own.isZero() || triangles[source[t]] == kNoTriangle) continue;
    const auto face = static_cast<std::uint32_t>(triangles[source[t]]);
    const int x = static_cast<int>(t % static_cast<std::size_t>(model.width)), y = static_cast<int>(t / static_cast<std::size_t>(model.width));
    const Eigen::Vector2d at = texel_barycentric(model, x, y, face);
    const Eigen::Vector3d in_surface = tangent_frame(model.mesh, tangents, face, at.x(), at.y()).inverse() * own;
    const Eigen::Vector3d turned = (tangent_frame(mesh, moved_tangents, face, at.x(), at.y()) * in_surface).normalized();
    for (std::size_t k = 0; k < 3; ++k) model.normal.data[3 * t + k] = static_cast<float>(turned[static_cast<Eigen::Index>(k)]);
  }
  model.mesh = std::move(mesh);
  return model;
}

}  // namespace lumitexel
