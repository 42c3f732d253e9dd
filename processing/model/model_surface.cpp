#include "processing/model/model_surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace lumitexel {

const TexelShare& nearest_texel(const TexturedPoint& point) {
  return *std::max_element(point.texels.begin(), point.texels.begin() + point.texel_count,
                           [](const TexelShare& a, const TexelShare& b) { return a.weight < b.weight; });
}

ModelSurface::ModelSurface(const Model& model) : model_(model), scene_(model.mesh) {}

std::optional<TexturedPoint> ModelSurface::trace(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const {
  const std::optional<RayHit> hit = scene_.closest(origin, direction);
  if (!hit) return std::nullopt;
  const Mesh& mesh = model_.mesh;
  const auto& [a, b, c] = mesh.triangles[hit->triangle];
  const auto interpolate = [&, i = a, j = b, k = c](const auto& attribute) {
    return ((1.0 - hit->u - hit->v) * attribute[i] + hit->u * attribute[j] + hit->v * attribute[k]).eval();
  };
  TexturedPoint point;
  // From the corners, not from the ray's length: Embree measures that in single precision.
  point.position_in_world = interpolate(mesh.positions);
  point.geometric_normal =
      (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]).normalized();
  point.vertex_normal = interpolate(mesh.normals).normalized();
  point.triangle = hit->triangle;
  point.u = hit->u;
  point.v = hit->v;
  add_texels(interpolate(mesh.texcoords), point);
  return point;
}

void ModelSurface::add_texels(const Eigen::Vector2d& texcoord, TexturedPoint& point) const {
  const double x = texcoord.x() * model_.width - 0.5, y = (1.0 - texcoord.y()) * model_.height - 0.5;
  const double left = std::floor(x), top = std::floor(y);
  double total = 0.0;
  for (int corner = 0; corner < 4; ++corner) {
    const int dx = corner & 1, dy = corner >> 1;
    const double weight = (dx == 1 ? x - left : 1.0 - (x - left)) * (dy == 1 ? y - top : 1.0 - (y - top));
    const int tx = std::clamp(static_cast<int>(left) + dx, 0, model_.width - 1);
    const int ty = std::clamp(static_cast<int>(top) + dy, 0, model_.height - 1);
    const auto texel =
        static_cast<std::size_t>(ty) * static_cast<std::size_t>(model_.width) + static_cast<std::size_t>(tx);
    if (weight <= 0.0 || model_.material[texel] == Model::kNoMaterial) continue;
    point.texels[static_cast<std::size_t>(point.texel_count++)] = {tx, ty, weight};
    total += weight;
  }
  for (int i = 0; i < point.texel_count; ++i) point.texels[static_cast<std::size_t>(i)].weight /= total;
}

bool ModelSurface::sees(const TexturedPoint& point, const Light& light) const {
  const Eigen::Vector3d start = start_above(point);
  const double distance_m = light.type == Light::Type::Point ? (light.vector_in_world - start).norm()
                                                             : std::numeric_limits<double>::infinity();
  return !scene_.occluded(start, light.direction_from(start), 0.0, distance_m);
}

bool ModelSurface::sees_sky(const TexturedPoint& point, const Eigen::Vector3d& direction) const {
  return !scene_.occluded(start_above(point), direction, 0.0, std::numeric_limits<double>::infinity());
}

Eigen::Vector3d ModelSurface::start_above(const TexturedPoint& point) const {
  return point.position_in_world + scene_.surface_offset_m() * point.geometric_normal;
}

Eigen::Vector3d ModelSurface::shading_normal(const TexelShare& texel, const TexturedPoint& point, FitStage stage) const {
  if (has_normals(model_) && stage < FitStage::Normal) return point.vertex_normal;
  const Eigen::Vector3d normal(model_.normal.at(texel.x, texel.y, 0), model_.normal.at(texel.x, texel.y, 1),
                               model_.normal.at(texel.x, texel.y, 2));
  return normal.isZero() ? point.vertex_normal : normal.normalized();
}

}  // namespace lumitexel
