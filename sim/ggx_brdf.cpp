#include "sim/ggx_brdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

Eigen::Array3d schlick(const Eigen::Array3d& f0, double cosine) {
  const double rest = 1.0 - std::min(1.0, cosine);
  return f0 + (1.0 - f0) * (rest * rest * rest * rest * rest);
}

}  // namespace

Eigen::Array3d evaluate(const GgxBrdf& brdf, const LobeGeometry& geometry, double albedo_scale) {
  const double cos_i = geometry.cos_i, cos_o = geometry.cos_o;
  if (!(cos_i > 0.0 && cos_o > 0.0)) return Eigen::Array3d::Zero();
  const double half_length_sq = 2.0 + 2.0 * geometry.wi_dot_wo();  // |wi + wo|^2
  const double cos_h_sq = std::min(1.0, (cos_i + cos_o) * (cos_i + cos_o) / half_length_sq);
  const double cos_d = 0.5 * std::sqrt(half_length_sq);
  const double a2 = brdf.alpha * brdf.alpha;
  const double width = a2 * cos_h_sq + (1.0 - cos_h_sq);
  const double distribution = a2 / (std::numbers::pi * width * width);
  // G2 / (4 cos i cos o), where the cosines of the denominator have cancelled.
  const double visibility = 0.5 / (cos_o * std::sqrt(a2 + (1.0 - a2) * cos_i * cos_i) +
                                   cos_i * std::sqrt(a2 + (1.0 - a2) * cos_o * cos_o));
  const Eigen::Array3d specular = schlick(brdf.f0, cos_d) * (distribution * visibility);
  const Eigen::Array3d base = brdf.diffuse * (albedo_scale / std::numbers::pi) * (1.0 - schlick(brdf.f0, cos_i)) *
                              (1.0 - schlick(brdf.f0, cos_o));
  return specular + base;
}

}  // namespace lumitexel
