// A model's mesh made ready for rays: where a ray meets it, which texels lie there, and what the light sees of it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "processing/calibration/calibrated_session.h"
#include "processing/model/model.h"
#include "processing/surface/ray_scene.h"

namespace lumitexel {

// A texel with a material and its share of a surface point, by bilinear interpolation of the atlas.
struct TexelShare {
  int x = 0, y = 0;
  double weight = 0;
};

struct TexturedPoint {
  Eigen::Vector3d position_in_world, geometric_normal, vertex_normal;  // unit; vertex_normal interpolated
  // The texels around the point that have a material, weights summing to 1; none at all in a hole of the atlas.
  std::array<TexelShare, 4> texels;
  int texel_count = 0;
  std::uint32_t triangle = 0;
  double u = 0, v = 0;  // barycentric weights of its second and third corner
};

// Of a point that has any.
const TexelShare& nearest_texel(const TexturedPoint& point);

class ModelSurface {
 public:
  // Keeps a reference to the model. Its mesh needs texture coordinates.
  explicit ModelSurface(const Model& model);

  std::optional<TexturedPoint> trace(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  // Nothing between the point and the light. The shadow ray starts a hair above the triangle, on the side of its
  // geometric normal, so that a triangle that faces away from the light shades itself.
  bool sees(const TexturedPoint& point, const Light& light) const;
  // The same of the sky in a direction.
  bool sees_sky(const TexturedPoint& point, const Eigen::Vector3d& direction) const;
  // Where a ray starts that leaves the surface: that hair above the triangle.
  Eigen::Vector3d start_above(const TexturedPoint& point) const;
  // Of the texel; the interpolated vertex normal where the texel has none, and at the stages before normals were fitted.
  Eigen::Vector3d shading_normal(const TexelShare& texel, const TexturedPoint& point, FitStage stage) const;

  const Model& model() const { return model_; }

 private:
  void add_texels(const Eigen::Vector2d& texcoord, TexturedPoint& point) const;

  const Model& model_;
  RayScene scene_;
};

}  // namespace lumitexel
