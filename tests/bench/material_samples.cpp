#include "tests/bench/material_samples.h"

#include <cmath>
#include <numbers>
#include <random>

#include "processing/surface/gather_lumitexels.h"

namespace lumitexel {
namespace {

constexpr double kHeldoutCosine = 0.1;

// Fibonacci's spiral: even areas.
Eigen::Vector3d spread_normal(int i, int count) {
  const double z = 1.0 - 2.0 * (i + 0.5) / count, azimuth = std::numbers::pi * (3.0 - std::sqrt(5.0)) * i;
  const double across = std::sqrt(1.0 - z * z);
  return {across * std::cos(azimuth), across * std::sin(azimuth), z};
}

}  // namespace

SeenSphere sphere_on_rig(const RigDescription& rig, const CapturePlan& plan, double radius_m, int lumitexels) {
  SeenSphere seen;
  const Eigen::Vector3d centre = rig.light_positioner.pivot_in_rig, eye = rig.camera.camera_from_rig.inverse().translation();
  for (int i = 0; i < lumitexels; ++i) {
    for (const PlannedView& view : plan.views) {
      const Eigen::Vector3d normal = rig.turntable.rig_from_table(view.turntable_deg).linear() * spread_normal(i, lumitexels);
      const Eigen::Vector3d point = centre + radius_m * normal;
      const Eigen::Vector3d lamp = rig.light_positioner.nominal_position_in_rig(view.light_azimuth_deg, view.light_elevation_deg);
      const LobeGeometry geometry = lobe_geometry(normal, (lamp - point).normalized(), (eye - point).normalized());
      const double least = view.heldout ? kHeldoutCosine : kGrazingCosine;
      if (geometry.cos_i > least && geometry.cos_o > least) (view.heldout ? seen.heldout : seen.fit).push_back(geometry);
    }
    seen.first.push_back(seen.fit.size());
  }
  return seen;
}

Observations photographed(const BrdfValues& material, const SeenSphere& sphere, const PhotographNoise& noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Observations observations;
  observations.channels = 3;
  observations.first = sphere.first;
  for (const LobeGeometry& geometry : sphere.fit) {
    Observation& sample = observations.samples.emplace_back();
    sample.geometry = geometry;
    const ChannelValues f = material(geometry);
    for (std::size_t c = 0; c < 3; ++c) {
      const double r = f[c] * geometry.cos_i;
      const double seen = r + std::hypot(noise.relative * r, noise.floor) * normal(random);
      sample.reflectance[c] = static_cast<float>(seen);
      sample.variance[c] = static_cast<float>(std::pow(noise.relative * seen, 2) + std::pow(noise.floor, 2));
    }
  }
  return observations;
}

}  // namespace lumitexel
