#include "processing/brdf/lafortune.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

double evaluate_lobe(const LafortuneLobe& lobe, const LobeGeometry& geometry) {
  const double sine = std::sin(lobe.phi), cosine = std::cos(lobe.phi);
  const double scale = std::max(std::abs(sine), std::abs(cosine));
  const double normal_part = geometry.cos_i * geometry.cos_o;
  const double base = (-sine * (geometry.wi_dot_wo - normal_part) + cosine * normal_part) / scale;
  if (base <= 0.0) return 0.0;
  // One exponential of the whole logarithm: neither the peak nor the power can overflow on its own.
  return std::exp(lobe.log_peak + std::exp(lobe.log_exponent) * std::log(base));
}

}  // namespace

LobeGeometry lobe_geometry(const Eigen::Vector3d& normal, const Eigen::Vector3d& wi, const Eigen::Vector3d& wo) {
  return {wi.dot(wo), normal.dot(wi), normal.dot(wo)};
}

double evaluate(const LafortuneBrdf& brdf, int c, const LobeGeometry& geometry) {
  if (geometry.cos_i <= 0.0 || geometry.cos_o <= 0.0) return 0.0;
  const auto channel = static_cast<std::size_t>(c);
  double value = brdf.diffuse[channel];
  for (const auto& lobe : brdf.lobes) value += evaluate_lobe(lobe[channel], geometry);
  return value;
}

}  // namespace lumitexel
