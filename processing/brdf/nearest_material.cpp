#include "processing/brdf/nearest_material.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kMostHalf_deg = 80.0, kMostDifference_deg = 80.0;
constexpr int kHalves = 24, kDifferences = 9, kAzimuths = 6;

// Half vector (theta_h, 0), difference vector (theta_d, phi_d) as Rusinkiewicz has them; theta_h by squares, dense at the peak.
std::vector<LobeGeometry> quadrature() {
  std::vector<LobeGeometry> geometries;
  const Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
  for (int h = 0; h < kHalves; ++h) {
    const double at = (h + 0.5) / kHalves, theta_h = kMostHalf_deg * kDegree * at * at;
    const Eigen::Vector3d half(std::sin(theta_h), 0.0, std::cos(theta_h));
    const Eigen::Vector3d along(std::cos(theta_h), 0.0, -std::sin(theta_h));
    for (int d = 0; d < kDifferences; ++d) {
      const double theta_d = kMostDifference_deg * kDegree * (d + 0.5) / kDifferences;
      for (int p = 0; p < kAzimuths; ++p) {
        const double phi = std::numbers::pi * (p + 0.5) / kAzimuths;
        const Eigen::Vector3d across = std::cos(phi) * along + std::sin(phi) * Eigen::Vector3d::UnitY();
        const Eigen::Vector3d wi = std::cos(theta_d) * half + std::sin(theta_d) * across;
        const Eigen::Vector3d wo = std::cos(theta_d) * half - std::sin(theta_d) * across;
        if (wi.z() > 0.0 && wo.z() > 0.0) geometries.push_back(lobe_geometry(normal, wi, wo));
      }
    }
  }
  return geometries;
}

const std::vector<LobeGeometry>& fixed_quadrature() {
  static const std::vector<LobeGeometry> geometries = quadrature();
  return geometries;
}

}  // namespace

double material_distance(const BrdfValues& a, const BrdfValues& b, int channels) {
  double sum = 0.0;
  for (const LobeGeometry& geometry : fixed_quadrature()) {
    const ChannelValues left = a(geometry), right = b(geometry);
    for (std::size_t c = 0; c < static_cast<std::size_t>(channels); ++c) {
      const double difference = std::cbrt(left[c] * geometry.cos_i) - std::cbrt(right[c] * geometry.cos_i);
      sum += difference * difference;
    }
  }
  return std::sqrt(sum / (static_cast<double>(fixed_quadrature().size()) * channels));
}

std::vector<NearMaterial> nearest_materials(const Brdf& brdf, std::span<const KnownMaterial> known) {
  std::vector<NearMaterial> result;
  const BrdfValues own = [&](const LobeGeometry& geometry) { return evaluate(brdf, geometry); };
  for (std::size_t i = 0; i < known.size(); ++i) result.push_back({i, material_distance(own, known[i].values, brdf.channels)});
  std::stable_sort(result.begin(), result.end(), [](const NearMaterial& a, const NearMaterial& b) { return a.distance < b.distance; });
  return result;
}

}  // namespace lumitexel
