#include "processing/render/texel_triangles.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kOnEdge = 1e-9;  // barycentric: a centre on a shared edge belongs to somebody

Eigen::Vector2d texel_of(const Model& model, std::uint32_t vertex) {  // a whole and a half is a texel's centre
  const Eigen::Vector2d& uv = model.mesh.texcoords[vertex];
  return {uv.x() * model.width, (1.0 - uv.y()) * model.height};
}

// Columns: the triangle's second and third corner from the first, in texels.
Eigen::Matrix2d texel_edges(const Model& model, std::uint32_t triangle) {
  const auto& [a, b, c] = model.mesh.triangles[triangle];
  Eigen::Matrix2d edges;
  edges << texel_of(model, b) - texel_of(model, a), texel_of(model, c) - texel_of(model, a);
  return edges;
}

constexpr double kNoArea = 1e-12;  // square texels

void mark_texels(const Model& model, std::uint32_t triangle, std::vector<std::int32_t>& map) {
  const Eigen::Matrix2d edges = texel_edges(model, triangle);
  if (std::abs(edges.determinant()) < kNoArea) return;
  const Eigen::Matrix2d inverse = edges.inverse();
  const Eigen::Vector2d corner = texel_of(model, model.mesh.triangles[triangle][0]);
  const Eigen::Vector2d low = corner + edges.rowwise().minCoeff().cwiseMin(0.0);
  const Eigen::Vector2d high = corner + edges.rowwise().maxCoeff().cwiseMax(0.0);
  const int left = std::max(0, static_cast<int>(std::floor(low.x() - 0.5)));
  const int right = std::min(model.width - 1, static_cast<int>(std::ceil(high.x() - 0.5)));
  const int top = std::max(0, static_cast<int>(std::floor(low.y() - 0.5)));
  const int bottom = std::min(model.height - 1, static_cast<int>(std::ceil(high.y() - 0.5)));
  for (int y = top; y <= bottom; ++y) {
    for (int x = left; x <= right; ++x) {
      const Eigen::Vector2d at = inverse * (Eigen::Vector2d(x + 0.5, y + 0.5) - corner);
      if (at.minCoeff() < -kOnEdge || at.sum() > 1.0 + kOnEdge) continue;
      const auto texel =
          static_cast<std::size_t>(y) * static_cast<std::size_t>(model.width) + static_cast<std::size_t>(x);
      if (map[texel] == kNoTriangle && model.material[texel] != Model::kNoMaterial) {
        map[texel] = static_cast<std::int32_t>(triangle);
      }
    }
  }
}

}  // namespace

std::vector<std::int32_t> triangle_of_texel(const Model& model) {
  std::vector<std::int32_t> map(model.material.size(), kNoTriangle);
  for (std::uint32_t t = 0; t < model.mesh.triangles.size(); ++t) mark_texels(model, t, map);
  return map;
}

Eigen::Matrix<double, 3, 2> texel_steps(const Model& model, std::uint32_t triangle) {
  const Eigen::Matrix2d edges = texel_edges(model, triangle);
  if (std::abs(edges.determinant()) < kNoArea) return Eigen::Matrix<double, 3, 2>::Zero();
  const auto& [a, b, c] = model.mesh.triangles[triangle];
  const std::vector<Eigen::Vector3d>& positions = model.mesh.positions;
  Eigen::Matrix<double, 3, 2> sides;
  sides << positions[b] - positions[a], positions[c] - positions[a];
  return sides * edges.inverse();
}

TexturedPoint texel_point(const Model& model, int x, int y, std::uint32_t triangle) {
  const auto& [a, b, c] = model.mesh.triangles[triangle];
  const Eigen::Matrix2d edges = texel_edges(model, triangle);
  Eigen::Vector2d at = Eigen::Vector2d::Constant(1.0 / 3.0);
  if (std::abs(edges.determinant()) >= kNoArea) {
    at = edges.inverse() * (Eigen::Vector2d(x + 0.5, y + 0.5) - texel_of(model, a));
  }
  const auto interpolate = [&, i = a, j = b, k = c](const std::vector<Eigen::Vector3d>& attribute) {
    return ((1.0 - at.sum()) * attribute[i] + at.x() * attribute[j] + at.y() * attribute[k]).eval();
  };
  const std::vector<Eigen::Vector3d>& positions = model.mesh.positions;
  TexturedPoint point;
  point.position_in_world = interpolate(positions);
  point.geometric_normal = (positions[b] - positions[a]).cross(positions[c] - positions[a]).normalized();
  point.vertex_normal = interpolate(model.mesh.normals).normalized();
  point.texels[0] = {x, y, 1.0};
  point.texel_count = 1;
  return point;
}

}  // namespace lumitexel
