#include "processing/export/gltf_material.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "processing/brdf/lobe_family.h"

namespace lumitexel {

GltfFacets gltf_facets(double roughness, const LobeGeometry& geometry) {
  if (geometry.cos_i <= 0.0 || geometry.cos_o <= 0.0) return {};
  const double log_alpha = std::max(2.0 * std::log(roughness), kGgxFamily.least_log_shape);
  // The family's lobe is linear in F0: gain D V (1 - fall), offset D V fall.
  const LobeTerms terms = kGgxFamily.terms(log_alpha, kMirrorAim, geometry);
  const double value = terms.gain + terms.offset;
  return {value, value > 0.0 ? terms.offset / value : 0.0};
}

ChannelValues evaluate(const GltfMaterial& material, const LobeGeometry& geometry) {
  ChannelValues values{};
  if (geometry.cos_i <= 0.0 || geometry.cos_o <= 0.0) return values;
  const GltfFacets facets = gltf_facets(material.roughness, geometry);
  const double largest = *std::max_element(material.f0.begin(), material.f0.end());
  const double diffuse = (1.0 - largest - (material.specular - largest) * facets.fall) / std::numbers::pi;
  for (std::size_t c = 0; c < 3; ++c) {
    const double fresnel = material.f0[c] + (material.specular - material.f0[c]) * facets.fall;
    values[c] = material.base[c] * diffuse + fresnel * facets.value;
  }
  return values;
}

}  // namespace lumitexel
