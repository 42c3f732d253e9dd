#include "processing/brdf/numerics/reference_lobes.h"

#include <quadmath.h>

#include <Eigen/Core>
#include <cmath>

namespace lumitexel {
namespace {

const Quad kQuadPi = 4 * atanq(1);

// D of lafortune.cpp and its slope, from the gaps: p = cos_i cos_o, q = (mirror_gap - retro_gap) / 2. Stored fields agree with each
// other only to rounding, so 1 - D takes the one that carries the digits at the peak.
void lafortune_base(Quad phi, const QuadGeometry& g, Quad& base, Quad& slope) {
  const Quad size = fabsq(phi), sign = phi >= 0 ? 1 : -1, p = g.cos_i * g.cos_o;
  const Quad gap = phi >= 0 ? g.mirror_gap : g.retro_gap, other = phi >= 0 ? g.retro_gap : g.mirror_gap;
  const Quad tangent = tanq(size), cotangent = 1 / tangent;
  if (size <= kQuadPi / 4) {
    base = 1 - (gap * (1 + tangent) + other * (1 - tangent)) / 2;
    slope = -(g.mirror_gap - g.retro_gap) / 2 * (1 + tangent * tangent);
  } else {
    base = 1 - gap - (1 - cotangent) * p;
    slope = -sign * p * (1 + cotangent * cotangent);
  }
}

QuadSlopes lafortune(Quad log_exponent, Quad phi, const QuadGeometry& g) {
  Quad base = 0, slope = 0;
  lafortune_base(phi, g, base, slope);
  if (base <= 0) return {};
  const Quad exponent = expq(log_exponent), power = exponent * logq(base), value = expq(power);
  return {value, 0, value * power, 0, value * exponent * slope / base};
}

QuadSlopes ggx(Quad log_alpha, const QuadGeometry& g) {
  const Quad alpha2 = expq(2 * log_alpha), along = g.cos_i + g.cos_o, tangent2 = g.across2 / (along * along);
  const Quad stretched = 1 + tangent2 / alpha2, cosine2 = 1 / (1 + tangent2);
  const Quad distribution = 1 / (kQuadPi * alpha2 * cosine2 * cosine2 * stretched * stretched);
  const Quad root_i = sqrtq(alpha2 + (1 - alpha2) * g.cos_i * g.cos_i), root_o = sqrtq(alpha2 + (1 - alpha2) * g.cos_o * g.cos_o);
  const Quad below = g.cos_o * root_i + g.cos_i * root_o, value = distribution / (2 * below);
  const Quad root_slope = alpha2 * (g.cos_o * (1 - g.cos_i * g.cos_i) / root_i + g.cos_i * (1 - g.cos_o * g.cos_o) / root_o);
  const Quad slope = value * (-2 + 4 * (tangent2 / alpha2) / stretched - root_slope / below);
  const Quad cos_d = fminq(1, sqrtq(g.across2 + along * along) / 2), schlick = powq(1 - cos_d, 5);
  return {value * (1 - schlick), value * schlick, slope * (1 - schlick), slope * schlick, 0};
}

QuadSlopes ward(Quad log_alpha, const QuadGeometry& g) {
  const Quad alpha2 = expq(2 * log_alpha), along = g.cos_i + g.cos_o, tangent2 = g.across2 / (along * along);
  const Quad value = expq(-tangent2 / alpha2) / (kQuadPi * alpha2) * (g.across2 + along * along) / powq(along, 4);
  return {value, 0, value * (-2 + 2 * tangent2 / alpha2), 0, 0};
}

Eigen::Vector3d rounded_direction(double theta, double azimuth) {
  const Quad sine = sinq(theta);
  return {static_cast<double>(sine * cosq(azimuth)), static_cast<double>(sine * sinq(azimuth)), static_cast<double>(cosq(theta))};
}

}  // namespace

QuadGeometry as_stored(const LobeGeometry& g) { return {g.cos_i, g.cos_o, g.mirror_gap, g.retro_gap, g.across2}; }

QuadGeometry exact_geometry(const DirectionPair& pair) {
  const Quad sine_i = sinq(pair.theta_i), sine_o = sinq(pair.theta_o), cosine = cosq(pair.azimuth);
  QuadGeometry g{cosq(pair.theta_i), cosq(pair.theta_o), 0, 0, 0};
  g.across2 = sine_i * sine_i + sine_o * sine_o + 2 * sine_i * sine_o * cosine;
  g.mirror_gap = (g.across2 + (g.cos_i - g.cos_o) * (g.cos_i - g.cos_o)) / 2;
  g.retro_gap = 1 - g.cos_i * g.cos_o - sine_i * sine_o * cosine;
  return g;
}

LobeGeometry rounded_geometry(const DirectionPair& pair) {
  return lobe_geometry(Eigen::Vector3d::UnitZ(), rounded_direction(pair.theta_i, 0.0), rounded_direction(pair.theta_o, pair.azimuth));
}

QuadSlopes reference_slopes(BrdfFamily family, double log_shape, double aim, const QuadGeometry& geometry) {
  switch (family) {
    case BrdfFamily::Lafortune: return lafortune(log_shape, aim, geometry);
    case BrdfFamily::Ggx: return ggx(log_shape, geometry);
    case BrdfFamily::Ward: return ward(log_shape, geometry);
  }
  return {};
}

}  // namespace lumitexel
