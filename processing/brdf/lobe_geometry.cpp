#include "processing/brdf/lobe_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumitexel {

LobeGeometry lobe_geometry(const Eigen::Vector3d& normal, const Eigen::Vector3d& wi, const Eigen::Vector3d& wo) {
  LobeGeometry geometry;
  geometry.cos_i = normal.dot(wi);
  geometry.cos_o = normal.dot(wo);
  // An error of the cosines leaves this vector tangential but for second order. m(wi) - wo is its negative plus
  // (cos_i - cos_o) along the normal.
  geometry.across2 = ((wi - geometry.cos_i * normal) + (wo - geometry.cos_o * normal)).squaredNorm();
  const double difference = geometry.cos_i - geometry.cos_o;
  geometry.mirror_gap = 0.5 * (geometry.across2 + difference * difference);
  geometry.retro_gap = 0.5 * (wi - wo).squaredNorm();
  return geometry;
}

double half_tangent_squared(const LobeGeometry& geometry) {
  const double along = geometry.along();
  if (!(along > 0.0)) return std::numeric_limits<double>::infinity();
  return geometry.across2 / (along * along);
}

// |wi + wo| / 2, of parts that add without cancelling.
double cos_difference_angle(const LobeGeometry& geometry) {
  const double along = geometry.along();
  return std::min(1.0, 0.5 * std::sqrt(geometry.across2 + along * along));
}

}  // namespace lumitexel
