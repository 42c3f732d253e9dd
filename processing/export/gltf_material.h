// The material that glTF 2.0 calls metallic-roughness with KHR_materials_specular, not metallic, as appendix B of its specification and
// the extension's text define it:
//
//   f = base / pi (1 - max_c F_c) + F D V,   F_c = f0_c + (specular - f0_c) (1 - cos_d)^5,
//
// D the GGX distribution of alpha = roughness^2, V Smith's height-correlated visibility. f0 = specular min(0.04 specularColor, 1), so that
// coloured and metal-like highlights need no metalness.
#pragma once

#include <array>

#include "processing/brdf/brdf.h"

namespace lumitexel {

struct GltfMaterial {
  std::array<double, 3> base{};  // linear, 0 to 1
  std::array<double, 3> f0{};    // linear, 0 to 1
  double roughness = 1;          // 0 to 1
  double specular = 1;           // specularFactor, 0 to 1: what F becomes at grazing angles; f0 <= specular
};

// D V, 1/sr, and (1 - cos_d)^5; zeros if either direction is below the surface.
struct GltfFacets {
  double value = 0, fall = 0;
};
GltfFacets gltf_facets(double roughness, const LobeGeometry& geometry);

// f per channel, 1/sr.
ChannelValues evaluate(const GltfMaterial& material, const LobeGeometry& geometry);

}  // namespace lumitexel
