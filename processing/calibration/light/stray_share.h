// How much a stray light adds to what the rig's lamp gives, at a place that both light.
//
// A highlight on a sphere holds flux F ~ rho * I / d^2 (flux_of; rho the sphere's reflectance, d from the sphere's mirror point to
// the light). Lamp and stray on one sphere share rho, so
//   I_stray / I_lamp = median over the spheres of (F d^2)_stray / (F d^2)_lamp,
// the lamp's own F d^2 being its median on that sphere over the views, the stray's too. At a place x with normal n the share is then
//   s = E_stray / E_lamp = I_stray / I_lamp * (cos_stray / D_stray^2) / (cos_lamp / D_lamp^2).
// Both are taken to shine alike on the spheres and on x, and nothing to stand between the stray and x: where something does, s is
// more than there is. Camera's frame, metres; one value a channel (mosaic: 3, mono: three times the same), none where it is not known:
// where a highlight's flux in that channel is not (HighlightPixel: red and blue of pictures that were binned), and where lamp or stray
// have hardly any light there.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "processing/calibration/light/stray_lights.h"

namespace lumitexel {

using Strength = std::array<std::optional<double>, 3>;  // F d^2 per colour; above a fiftieth of the brightest colour's, or none

// The lamp's, per sphere of the line; measured lights only.
std::vector<Strength> lamp_strengths(const SphereHighlights& seen, const LightSolution& lights);

struct MeasuredShare {
  double value = 0, sigma = 0;
};
using ShareOfChannels = std::array<std::optional<MeasuredShare>, 3>;

// Intensity over the lamp's, with the stray at `position`. sigma: the spheres' scatter (highlights of one sphere share its errors; a
// sphere with more than one stands for one), with Student's t for their small number, and 2 % that all have in common. None with fewer than
// two spheres that show both, or below three sigmas.
ShareOfChannels stray_ratio(const StrayLight& stray, const Eigen::Vector3d& position, const SphereLine& line,
                            const std::vector<Strength>& lamp);

struct LitPlace {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  // unit
};

// s; 0 where the place faces away from the stray. sigma: the ratio's, and the stray's position carried through everything. None as
// stray_ratio, and of all channels where the place does not face the lamp.
ShareOfChannels stray_share(const StrayLight& stray, const SphereLine& line, const std::vector<Strength>& lamp,
                            const LitPlace& place, const Eigen::Vector3d& lamp_position);

}  // namespace lumitexel
