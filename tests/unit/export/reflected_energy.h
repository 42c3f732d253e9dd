#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "processing/brdf/lobe_geometry.h"

namespace lumitexel {

// Reflected share of light that comes from the viewer's angle, by the midpoint rule. value: f in one channel, of a LobeGeometry.
template <typename F>
double reflected_energy(const F& value, double angle) {
  const Eigen::Vector3d wo(std::sin(angle), 0, std::cos(angle));
  constexpr int kRings = 600, kTurns = 600;
  double sum = 0.0;
  for (int i = 0; i < kRings; ++i) {
    const double sin2 = (i + 0.5) / kRings, z = std::sqrt(1.0 - sin2);
    for (int j = 0; j < kTurns; ++j) {
      const double turn = 2.0 * std::numbers::pi * (j + 0.5) / kTurns;
      const Eigen::Vector3d wi(std::sqrt(sin2) * std::cos(turn), std::sqrt(sin2) * std::sin(turn), z);
      sum += value(lobe_geometry(Eigen::Vector3d::UnitZ(), wi, wo));
    }
  }
  return sum * std::numbers::pi / (kRings * kTurns);
}

}  // namespace lumitexel
