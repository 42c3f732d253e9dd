// A model as a cloud of points: every texel that lies on the mesh, and one for each triangle that holds no texel's
// centre.
#pragma once

#include <cstdint>
#include <vector>

#include "processing/model/model_surface.h"

namespace lumitexel {

struct SurfacePoint {
  std::int32_t x = 0, y = 0;  // the texel
  std::uint32_t triangle = 0;
  // How far the point reaches for its neighbours, in world, metres: the steps of one texel. Of a triangle without
  // texels, such that the same kernel covers it.
  Eigen::Matrix<double, 3, 2> steps = Eigen::Matrix<double, 3, 2>::Zero();
  bool of_texel = true;
};

// In the order of the texels, then of the triangles.
std::vector<SurfacePoint> surface_points(const Model& model);

// Where it is: with that texel alone.
TexturedPoint textured(const Model& model, const SurfacePoint& point);

}  // namespace lumitexel
