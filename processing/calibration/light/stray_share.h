// How much a stray light adds to what the rig's lamp gives, at a place that both light.
//
// A highlight on a sphere holds flux F ~ rho * I / d^2 (flux_of; rho the sphere's reflectance, d from the sphere's mirror point to
// the light). Lamp and stray on one sphere share rho, so
//   I_stray / I_lamp = median over the stray's highlights of (F d^2)_stray / (F d^2)_lamp,
// the lamp's own F d^2 being its median on that sphere over the views. At a place x with normal n the share is then
//   s = E_stray / E_lamp = I_stray / I_lamp * (cos_stray / D_stray^2) / (cos_lamp / D_lamp^2).
// Both are taken to shine alike on the spheres and on x, and nothing to stand between the stray and x: where something does, s is
// more than there is. Camera's frame, metres; one value a channel (mosaic: 3, mono: 1).
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "processing/calibration/light/stray_lights.h"

namespace lumitexel {

using Strength = std::array<double, 3>;  // F d^2 per colour

// The lamp's, per sphere of the line: none where no view shows it there under a measured light.
std::vector<std::optional<Strength>> lamp_strengths(const SphereHighlights& seen, const LightSolution& lights);

struct StrayRatio {
  Strength value{};           // intensity over the lamp's, per colour
  double relative_sigma = 0;  // by the highlights' scatter and what all highlights share
};
// With the stray at `position`. None if no sphere of the stray's has the lamp.
std::optional<StrayRatio> stray_ratio(const StrayLight& stray, const Eigen::Vector3d& position, const SphereLine& line,
                                      const std::vector<std::optional<Strength>>& lamp);

struct LitPlace {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit
};

struct StrayShare {
  Strength value{}, sigma{};  // s; 0 where the place faces away from the stray
};
// sigma: the ratio's, and the stray's position carried through everything. None as stray_ratio. The place faces the lamp.
std::optional<StrayShare> stray_share(const StrayLight& stray, const SphereLine& line,
                                      const std::vector<std::optional<Strength>>& lamp, const LitPlace& place,
                                      const Eigen::Vector3d& lamp_position);

}  // namespace lumitexel
