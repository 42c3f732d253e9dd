// The materials that the fit found: where they are on the object, and how each looks on a sphere.
#pragma once

#include <array>
#include <vector>

#include "processing/model/render_view.h"

namespace lumitexel {

// Well apart for up to twelve materials, then repeating with another lightness. sRGB in [0, 1].
std::array<float, 3> material_colour(int material);

// The object with every material in its colour, shaded lightly so that its form can be seen. White beside the object,
// gray where nothing was measured.
Image material_map(const ViewRenderer& renderer, const View& view);

// A sphere of one material (its cluster's BRDF), seen from the front, lit by a directional light from above left that
// gives an ideal white surface facing it radiance 1. Linear radiance; `white` of sphere_white shows all of them alike.
Image material_sphere(const Brdf& brdf, int size_px);
double sphere_white(const std::vector<Image>& spheres);

}  // namespace lumitexel
