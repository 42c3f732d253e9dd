#include "processing/export/material_form.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

constexpr double kLeastAlpha = 1e-4;  // Mitsuba's own

double smith_g1(double alpha2, double cosine) {
  const double tangent2 = (1.0 - cosine * cosine) / (cosine * cosine);
  return 2.0 / (1.0 + std::sqrt(1.0 + alpha2 * tangent2));
}

double mitsuba_facets(double roughness, const LobeGeometry& geometry) {
  const double alpha = std::max(roughness * roughness, kLeastAlpha), alpha2 = alpha * alpha;
  const double tangent2 = half_tangent_squared(geometry), cos2 = 1.0 / (1.0 + tangent2);
  const double spread = cos2 * (tangent2 + alpha2);  // not through cos^4 alone: a sharp lobe would lose its digits
  const double distribution = alpha2 / (std::numbers::pi * spread * spread);
  return distribution * smith_g1(alpha2, geometry.cos_i) * smith_g1(alpha2, geometry.cos_o) / (4.0 * geometry.normal_product());
}

ChannelValues evaluate_in_mitsuba(const GltfMaterial& material, const LobeGeometry& geometry) {
  ChannelValues values{};
  if (geometry.cos_i <= 0.0 || geometry.cos_o <= 0.0) return values;
  const double highlight = mitsuba_facets(material.roughness, geometry);
  for (std::size_t c = 0; c < 3; ++c) {
    values[c] = (1.0 - material.specular) * material.base[c] / std::numbers::pi + material.f0[c] * highlight;
  }
  return values;
}

}  // namespace

GltfFacets facets(MaterialForm form, double roughness, const LobeGeometry& geometry) {
  if (form == MaterialForm::Gltf) return gltf_facets(roughness, geometry);
  if (geometry.cos_i <= 0.0 || geometry.cos_o <= 0.0) return {};
  return {mitsuba_facets(roughness, geometry), 0.0};
}

ChannelValues evaluate(MaterialForm form, const GltfMaterial& material, const LobeGeometry& geometry) {
  return form == MaterialForm::Gltf ? evaluate(material, geometry) : evaluate_in_mitsuba(material, geometry);
}

}  // namespace lumitexel
