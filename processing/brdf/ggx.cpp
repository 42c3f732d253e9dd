// Microfacets of the GGX distribution (Walter, Marschner, Li, Torrance 2007) with Smith's height-correlated masking (Heitz 2014) and
// Schlick's Fresnel term:
//
//   f = D G F / (4 cos_i cos_o),   D = 1 / (pi alpha^2 cos^4 (1 + tan^2 / alpha^2)^2) at the half vector,   F = F0 + (1 - F0) (1 - cos_d)^5,
//
// with tan^2 = across^2 / along^2 (lobe_geometry.h) D = alpha^2 / pi ((across^2 + along^2) / (across^2 + alpha^2 along^2))^2, where nothing
// cancels at any angle;
//
//   G / (4 cos_i cos_o) = 1/2 / (cos_o sqrt(alpha^2 + (1 - alpha^2) cos_i^2) + cos_i sqrt(alpha^2 + (1 - alpha^2) cos_o^2))
#include <cmath>

#include "processing/brdf/half_vector_family.h"
#include "processing/brdf/lobe_family.h"

namespace lumitexel {
namespace {

struct Facets {
  double value = 0, by_log_alpha = 0;  // D G / (4 cos_i cos_o) and its slope
  double schlick = 0;                  // (1 - cos_d)^5
};

Facets facets(const LobeShape& shape, const LobeGeometry& g) {
  const double along2 = g.along() * g.along();
  if (along2 < kLeastAlong2) return {};
  const double alpha2 = shape.shape * shape.shape;
  const double stretched = g.across2 + alpha2 * along2;
  const double spread = (g.across2 + along2) / stretched;
  const double root_i = std::sqrt(alpha2 + (1.0 - alpha2) * g.cos_i * g.cos_i);
  const double root_o = std::sqrt(alpha2 + (1.0 - alpha2) * g.cos_o * g.cos_o);
  const double below = g.cos_o * root_i + g.cos_i * root_o;
  Facets result;
  result.value = alpha2 * spread * spread / kPi * 0.5 / below;
  const double by_distribution = 2.0 * (g.across2 - alpha2 * along2) / stretched;  // d ln D / d ln alpha
  const double by_root = alpha2 * (g.cos_o * (1.0 - g.cos_i * g.cos_i) / root_i + g.cos_i * (1.0 - g.cos_o * g.cos_o) / root_o);
  result.by_log_alpha = result.value * (by_distribution - by_root / below);
  const double fall = 0.5 * g.retro_gap / (1.0 + cos_difference_angle(g));  // 1 - cos_d = sin^2 / (1 + cos)
  result.schlick = fall * fall * fall * fall * fall;
  return result;
}

LobeTerms terms(const LobeShape& shape, const LobeGeometry& geometry) {
  const Facets f = facets(shape, geometry);
  return {f.value * (1.0 - f.schlick), f.value * f.schlick};
}

LobeSlopes slopes(const LobeShape& shape, const LobeGeometry& geometry) {
  const Facets f = facets(shape, geometry);
  return {f.value * (1.0 - f.schlick), f.value * f.schlick, f.by_log_alpha * (1.0 - f.schlick), f.by_log_alpha * f.schlick, 0.0};
}

}  // namespace

const LobeFamily kGgxFamily = half_vector_family("ggx", terms, slopes);

}  // namespace lumitexel
