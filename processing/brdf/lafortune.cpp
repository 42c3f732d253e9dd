// The isotropic Lafortune lobe (eq. 6 and 7 of the paper), written by its peak:
//
//   A max(0, D)^N,   D = (-sin(phi) q + cos(phi) p) / max(|sin(phi)|, |cos(phi)|),   q = tangential part of wi . wo, p = cos_i cos_o
//
// In the paper's form Cx = Cy = -sin(phi) s, Cz = cos(phi) s with s = A^(1/N) / max(|sin|, |cos|). D <= 1, so A is the value at the
// peak, and neither it nor the power can overflow. phi = pi/4 is the mirror direction, -pi/4 retro-reflection.
#include <algorithm>
#include <cmath>
#include <limits>

#include "processing/brdf/lafortune_base.h"
#include "processing/brdf/lobe_family.h"

namespace lumitexel {
namespace {

constexpr double kHalfPi = 1.5707963267948966, kTwoPi = 6.283185307179586;
constexpr double kLogShapes[] = {1.0986122886681098, 2.302585092994046, 3.4011973816621555,
                                 4.605170185988092,  5.703782474656201, 6.907755278982137};  // N = 3, 10, 30, 100, 300, 1000

// Below this base a power under kSteepLogExponent shows the rounding of 1 - D; far below zero there is no lobe anyway.
constexpr double kSmallBase = 0.0625, kRounding = 1e-12;
constexpr double kSteepLogExponent = 1.5;

struct Base {
  double value = 0;  // D; not positive: no lobe there
  double log = 0;    // ln D
};

Base base_at(const LobeShape& shape, const LobeGeometry& geometry) {
  const double below_one = shape.toward.below_one(geometry), plain = 1.0 - below_one;
  if (plain >= kSmallBase) return {plain, std::log1p(-below_one)};
  const bool careful = plain > -kRounding && shape.log_shape < kSteepLogExponent;
  const double value = careful ? careful_base(shape.aim, geometry) : plain;
  return value > 0.0 ? Base{value, std::log(value)} : Base{};
}

LobeTerms terms(const LobeShape& shape, const LobeGeometry& geometry) {
  const Base base = base_at(shape, geometry);
  if (base.value <= 0.0) return {};
  return {std::exp(shape.shape * base.log), 0.0};
}

LobeSlopes slopes(const LobeShape& shape, const LobeGeometry& geometry) {
  const Base base = base_at(shape, geometry);
  if (base.value <= 0.0) return {};
  const double exponent = shape.shape;
  const double value = std::exp(exponent * base.log);
  // Where the power underflows the lobe is flat. Under an exponent below one the slope has no bound as the base goes to zero; the
  // smallest normal base keeps it finite.
  if (value == 0.0) return {};
  const double over_base = value / std::max(base.value, std::numeric_limits<double>::min());
  return {value, 0.0, value * (exponent * base.log), 0.0, exponent * over_base * shape.toward.slope(geometry)};
}

// A lobe of exponent N and peak A reflects about 2 pi A / (N + 2) of the light.
double most_log_strength(double log_exponent, double energy) {
  return std::log(energy * (std::exp(log_exponent) + 2.0) / kTwoPi);
}

}  // namespace

const LobeFamily kLafortuneFamily{"lafortune", true, -4.605170185988091, 11.512925464970229, -kHalfPi, kHalfPi,
                                  most_log_strength, kLogShapes, terms, slopes};

}  // namespace lumitexel
