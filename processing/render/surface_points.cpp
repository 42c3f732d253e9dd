#include "processing/render/surface_points.h"

#include <algorithm>
#include <cmath>

#include "processing/render/texel_triangles.h"

namespace lumitexel {
namespace {

// A triangle's second moments are sides * [[2, -1], [-1, 2]] / 36 * sides^T, and its corners lie sqrt(8) standard
// deviations from its middle. With 0.6 of the root of that matrix the kernel's solid part (0.9 steps) reaches just
// beyond them.
Eigen::Matrix<double, 3, 2> triangle_steps(const Mesh& mesh, std::uint32_t triangle) {
  const auto& [a, b, c] = mesh.triangles[triangle];
  Eigen::Matrix<double, 3, 2> sides;
  sides << mesh.positions[b] - mesh.positions[a], mesh.positions[c] - mesh.positions[a];
  Eigen::Matrix2d root;
  root << std::sqrt(2.0), 0.0, -std::sqrt(0.5), std::sqrt(1.5);
  return sides * root * 0.6;
}

SurfacePoint point_of_triangle(const Model& model, std::uint32_t triangle) {
  Eigen::Vector2d uv = Eigen::Vector2d::Zero();
  for (const std::uint32_t vertex : model.mesh.triangles[triangle]) uv += model.mesh.texcoords[vertex] / 3.0;
  SurfacePoint point;
  point.x = std::clamp(static_cast<int>(uv.x() * model.width), 0, model.width - 1);
  point.y = std::clamp(static_cast<int>((1.0 - uv.y()) * model.height), 0, model.height - 1);
  point.triangle = triangle;
  point.steps = triangle_steps(model.mesh, triangle);
  point.of_texel = false;
  return point;
}

}  // namespace

std::vector<SurfacePoint> surface_points(const Model& model) {
  const std::vector<std::int32_t> map = triangle_of_texel(model);
  std::vector<SurfacePoint> points;
  std::vector<std::uint8_t> has_texel(model.mesh.triangles.size(), 0);
  for (std::size_t t = 0; t < map.size(); ++t) {
    if (map[t] == kNoTriangle) continue;
    SurfacePoint point;
    point.x = static_cast<std::int32_t>(t % static_cast<std::size_t>(model.width));
    point.y = static_cast<std::int32_t>(t / static_cast<std::size_t>(model.width));
    point.triangle = static_cast<std::uint32_t>(map[t]);
    point.steps = texel_steps(model, point.triangle);
    has_texel[point.triangle] = 1;
    points.push_back(point);
  }
  for (std::uint32_t triangle = 0; triangle < has_texel.size(); ++triangle) {
    if (has_texel[triangle] != 0) continue;
    const SurfacePoint point = point_of_triangle(model, triangle);
    const auto texel =
        static_cast<std::size_t>(point.y) * static_cast<std::size_t>(model.width) + static_cast<std::size_t>(point.x);
    if (model.material[texel] != Model::kNoMaterial) points.push_back(point);
  }
  return points;
}

TexturedPoint textured(const Model& model, const SurfacePoint& point) {
  TexturedPoint result = texel_point(model, point.x, point.y, point.triangle);
  if (point.of_texel) return result;
  const Mesh& mesh = model.mesh;
  result.position_in_world.setZero();
  result.vertex_normal.setZero();
  for (const std::uint32_t vertex : mesh.triangles[point.triangle]) {
    result.position_in_world += mesh.positions[vertex] / 3.0;
    result.vertex_normal += mesh.normals[vertex];
  }
  result.vertex_normal.normalize();
  return result;
}

}  // namespace lumitexel
