// The isotropic Lafortune lobe (eq. 6 and 7 of the paper), written by its peak:
//
//   A max(0, D)^N,   D = (-sin(phi) q + cos(phi) p) / max(|sin(phi)|, |cos(phi)|),   q = tangential part of wi . wo, p = cos_i cos_o
//
// In the paper's form Cx = Cy = -sin(phi) s, Cz = cos(phi) s with s = A^(1/N) / max(|sin|, |cos|). D <= 1, so A is the value at the
// peak, and neither it nor the power can overflow. phi = pi/4 is the mirror direction, -pi/4 retro-reflection.
#include <algorithm>
#include <cmath>

#include "processing/brdf/lobe_family.h"

namespace lumitexel {
namespace {

constexpr double kHalfPi = 1.5707963267948966, kTwoPi = 6.283185307179586;
constexpr double kQuarterPiRest = 3.061616997868383e-17;  // pi/4 minus its double
constexpr double kRoot2 = 1.4142135623730951;
constexpr double kLogShapes[] = {1.0986122886681098, 2.302585092994046, 3.4011973816621555,
                                 4.605170185988092,  5.703782474656201, 6.907755278982137};  // N = 3, 10, 30, 100, 300, 1000

struct Base {
  double value = 0;     // D; not positive: no lobe there
  double log = 0;       // ln D
  double by_aim = 0;    // dD / d(phi)
};

// a b + c d with the rounding errors of both products put back.
double sum_of_products(double a, double b, double c, double d) {
  const double first = a * b, second = c * d, sum = first + second;
  const double rest = sum - first;
  return sum + (((first - (sum - rest)) + (second - rest)) + (std::fma(a, b, -first) + std::fma(c, d, -second)));
}

// D = 1 - gap + lean * factor: near the peak the gap, which has all its digits, and what the aim is off the mirror (or the light).
Base base_at(double phi, const LobeGeometry& g) {
  const double p = g.normal_product(), sine = std::sin(phi), cosine = std::cos(phi);
  const bool forward = sine >= 0.0;
  const double size = std::abs(sine);
  // cos - |sin| without cancellation where the two are nearly equal.
  const double difference = kRoot2 * std::sin((kMirrorAim - std::abs(phi)) + kQuarterPiRest);
  const double gap = forward ? g.mirror_gap : g.retro_gap;
  Base base;
  double below_one;  // D - 1
  if (cosine >= size) {
    below_one = (forward ? difference : -difference) / cosine * g.tangential - gap;
    base.value = 1.0 + below_one;
    base.by_aim = -g.tangential / (cosine * cosine);
    if (base.value < 0.5) base.value = sum_of_products(-sine, g.tangential, cosine, p) / cosine;
  } else {
    below_one = difference / size * p - gap;
    base.value = 1.0 + below_one;
    base.by_aim = (forward ? -p : p) / (size * size);
    if (base.value < 0.5) base.value = sum_of_products(-sine, g.tangential, cosine, p) / size;
  }
  if (base.value > 0.0) base.log = base.value < 0.5 ? std::log(base.value) : std::min(0.0, std::log1p(below_one));
  return base;
}

LobeTerms terms(double log_exponent, double phi, const LobeGeometry& geometry) {
  const Base base = base_at(phi, geometry);
  if (base.value <= 0.0) return {};
  return {std::exp(std::exp(log_exponent) * base.log), 0.0};
}

LobeSlopes slopes(double log_exponent, double phi, const LobeGeometry& geometry) {
  const Base base = base_at(phi, geometry);
  if (base.value <= 0.0) return {};
  const double exponent = std::exp(log_exponent);
  const double value = std::exp(exponent * base.log);
  // At a base as small as the power underflows, 0 * infinity would be no number; the lobe is flat there.
  if (value == 0.0) return {};
  return {value, 0.0, value * exponent * base.log, 0.0, value * exponent * base.by_aim / base.value};
}

// A lobe of exponent N and peak A reflects about 2 pi A / (N + 2) of the light.
double most_log_strength(double log_exponent, double energy) {
  return std::log(energy * (std::exp(log_exponent) + 2.0) / kTwoPi);
}

}  // namespace

const LobeFamily kLafortuneFamily{"lafortune", true, -4.605170185988091, 11.512925464970229, -kHalfPi, kHalfPi,
                                  most_log_strength, kLogShapes, terms, slopes};

}  // namespace lumitexel
