// Which texels of a model's atlas are points of its surface, and which points.
#pragma once

#include <cstdint>
#include <vector>

#include "processing/model/model_surface.h"

namespace lumitexel {

inline constexpr std::int32_t kNoTriangle = -1;

// Per texel, row by row, the triangle whose image in the atlas holds the texel's centre; where several do, the first.
// kNoTriangle beside all of them and where there is no material.
std::vector<std::int32_t> triangle_of_texel(const Model& model);

// What a step of one texel to the right (column 0) and down (column 1) in the atlas is on the triangle, in world,
// metres. Zero for a triangle whose image has no area.
Eigen::Matrix<double, 3, 2> texel_steps(const Model& model, std::uint32_t triangle);

// The surface point at the texel's centre, with this texel alone; on the triangle's plane, also where the centre lies
// beside it.
TexturedPoint texel_point(const Model& model, int x, int y, std::uint32_t triangle);

}  // namespace lumitexel
