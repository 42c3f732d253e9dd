#include "processing/brdf/lobe_geometry.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lumitexel {

LobeGeometry lobe_geometry(const Eigen::Vector3d& normal, const Eigen::Vector3d& wi, const Eigen::Vector3d& wo) {
  LobeGeometry geometry;
  geometry.cos_i = normal.dot(wi);
  geometry.cos_o = normal.dot(wo);
  // m(wi) - wo = 2 cos_i n - wi - wo, and both gaps as sums of squares of differences.
  geometry.mirror_gap = 0.5 * (2.0 * geometry.cos_i * normal - wi - wo).squaredNorm();
  geometry.retro_gap = 0.5 * (wi - wo).squaredNorm();
  geometry.tangential = (wi - geometry.cos_i * normal).dot(wo - geometry.cos_o * normal);
  return geometry;
}

double half_tangent_squared(const LobeGeometry& geometry) {
  const double along = geometry.cos_i + geometry.cos_o, across = geometry.cos_i - geometry.cos_o;
  if (!(along > 0.0)) return std::numeric_limits<double>::infinity();
  // The mirror gap's vector is the tangential part of wi + wo, and cos_i - cos_o along the normal.
  return std::max(0.0, 2.0 * geometry.mirror_gap - across * across) / (along * along);
}

double cos_difference_angle(const LobeGeometry& geometry) {
  return std::sqrt(std::clamp(1.0 - 0.5 * geometry.retro_gap, 0.0, 1.0));
}

}  // namespace lumitexel
