#include "sim/oren_nayar_brdf.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumitexel {

Eigen::Array3d evaluate(const OrenNayarBrdf& brdf, const LobeGeometry& geometry, double albedo_scale) {
  const double cos_i = geometry.cos_i, cos_o = geometry.cos_o;
  if (!(cos_i > 0.0 && cos_o > 0.0)) return Eigen::Array3d::Zero();
  const double s2 = brdf.sigma_rad * brdf.sigma_rad;
  const double a = 1.0 - 0.5 * s2 / (s2 + 0.33), b = 0.45 * s2 / (s2 + 0.09);
  // cos(phi_i - phi_o) sin(a) tan(b) without an angle: the sines cancel, and the larger cosine stays below.
  const double along = std::max(0.0, geometry.wi_dot_wo() - cos_i * cos_o);
  return brdf.albedo * (albedo_scale / std::numbers::pi * (a + b * along / std::max(cos_i, cos_o)));
}

}  // namespace lumitexel
