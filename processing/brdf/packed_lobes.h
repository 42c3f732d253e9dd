// The families' lobes at one lane's geometry, in float: the formulas of lafortune_base.cpp, ggx.cpp and ward.cpp.
#pragma once

#include "processing/brdf/float_lanes.h"
#include "processing/brdf/lafortune_base.h"

namespace lumitexel::lanes {

inline constexpr float kLeastBase = 0x1p-46f;  // where the gaps' 48 bits end
inline constexpr double kLog2E = 1.4426950408889634;

// 1 - D = grazing' + mirror' mirror_gap + retro' retro_gap, since cos_i cos_o = 1 - (mirror_gap + retro_gap) / 2.
struct LafortuneLane {
  TwoFloats one_less, mirror, retro;                       // D = one_less + mirror * gap + retro * gap
  TwoFloats slope_constant, mirror_slope, retro_slope;     // dD / d(phi) likewise
  TwoFloats exponent, exponent_e;                          // N, and N log2(e)

  LafortuneLane(double log_exponent, double phi) {
    const LafortuneAim aim = lafortune_aim(phi);
    const double n = std::exp(log_exponent);
    one_less = two_floats(1.0 - aim.grazing);
    mirror = two_floats(0.5 * aim.grazing - aim.mirror);
    retro = two_floats(0.5 * aim.grazing - aim.retro);
    slope_constant = two_floats(-aim.grazing_slope);
    mirror_slope = two_floats(0.5 * aim.grazing_slope - aim.gap_slope);
    retro_slope = two_floats(0.5 * aim.grazing_slope + aim.gap_slope);
    exponent = two_floats(n);
    exponent_e = two_floats(n * kLog2E);
  }
};

// D, with `dark` where it is zero or below; there the number is one.
LUMITEXEL_LANE TwoFloats lafortune_base(const LafortuneLane& lane, const TwoFloats& mirror_gap, const TwoFloats& retro_gap, bool& dark) {
  const TwoFloats base = linear(lane.one_less, lane.mirror, mirror_gap, lane.retro, retro_gap);
  dark = !(base.high > kLeastBase);
  return {dark ? 1.0f : base.high, dark ? 0.0f : base.low};
}

// N log2 D
LUMITEXEL_LANE TwoFloats lafortune_power(const LafortuneLane& lane, const TwoFloats& base) {
  const Logarithm log = logarithm(base);
  const TwoFloats whole = product(lane.exponent, {log.exponent, 0.0f}), part = product(lane.exponent_e, log.log1p);
  const TwoFloats sum = ordered_sum(whole.high, part.high);
  return ordered_sum(sum.high, sum.low + (whole.low + part.low));
}

struct LobeLane {
  float gain, offset;
};

struct FacetLane {
  float alpha2, rest;  // alpha^2, 1 - alpha^2
  float scale;         // GGX: alpha^2 / (2 pi). Ward: 1 / (pi alpha^2)
  float rate;          // Ward: log2(e) / alpha^2

  FacetLane(double log_alpha, bool ggx) {
    constexpr double kPi = 3.141592653589793;
    const double square = std::exp(2.0 * log_alpha);
    alpha2 = static_cast<float>(square);
    rest = static_cast<float>(1.0 - square);
    scale = static_cast<float>(ggx ? square / (2.0 * kPi) : 1.0 / (kPi * square));
    rate = static_cast<float>(kLog2E / square);
  }
};

LUMITEXEL_LANE LobeLane ggx_lobe(const FacetLane& lane, float cos_i, float cos_o, float across2, float retro_gap) {
  const float along = cos_i + cos_o, along2 = along * along, length2 = across2 + along2;
  const float spread = length2 / fused(lane.alpha2, along2, across2);
  const float root_i = std::sqrt(fused(lane.rest * cos_i, cos_i, lane.alpha2));
  const float root_o = std::sqrt(fused(lane.rest * cos_o, cos_o, lane.alpha2));
  const float value = lane.scale * spread * spread / fused(cos_o, root_i, cos_i * root_o);
  const float fall = 0.5f * retro_gap / fused(0.5f, std::sqrt(length2), 1.0f), fall2 = fall * fall;
  const float schlick = fall2 * fall2 * fall;
  return {fused(-value, schlick, value), value * schlick};
}

LUMITEXEL_LANE float ward_lobe(const FacetLane& lane, float cos_i, float cos_o, float across2) {
  const float along = cos_i + cos_o, along2 = along * along;
  const float falling = power_of_two({-lane.rate * (across2 / along2), 0.0f});
  return falling * lane.scale * ((across2 + along2) / along2) / along2;
}

}  // namespace lumitexel::lanes
