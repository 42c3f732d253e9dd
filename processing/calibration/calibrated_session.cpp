#include "processing/calibration/calibrated_session.h"

namespace lumitexel {

Eigen::Vector3d Light::direction_from(const Eigen::Vector3d& x_in_world) const {
  return type == Type::Point ? (vector_in_world - x_in_world).normalized() : vector_in_world;
}

double Light::irradiance(const Eigen::Vector3d& x_in_world, int c) const {
  const double value = intensity[static_cast<std::size_t>(c)];
  if (type == Type::Directional) return value;
  const Eigen::Vector3d from_light = x_in_world - vector_in_world;
  if (pattern.parameters().isZero()) return value / from_light.squaredNorm();
  return value * irradiance_per_intensity(pattern, lamp_from_world * from_light);
}

}  // namespace lumitexel
