#include "processing/brdf/lafortune_base.h"

#include <cmath>

#include "processing/brdf/brdf.h"
#include "processing/brdf/double_double.h"

namespace lumitexel {
namespace {

constexpr double kQuarterPiRest = 3.061616997868383e-17;        // pi/4 minus its double
constexpr double kQuarterPiSecondRest = -7.486924524295849e-34;  // what that leaves
constexpr int kSeriesTerms = 28;  // (pi/4)^28 / 28! is below 1e-32

struct SineCosine {
  DoubleDouble sine, cosine;
};

// Taylor's series, for |x| up to pi/4.
SineCosine sine_and_cosine(const DoubleDouble& x) {
  SineCosine result{{}, {1.0, 0.0}};
  DoubleDouble term{1.0, 0.0};
  for (int n = 1; n <= kSeriesTerms; ++n) {
    term = term * x / n;
    DoubleDouble& sum = n % 2 == 1 ? result.sine : result.cosine;
    sum = sum + (n % 4 < 2 ? term : -term);
  }
  return result;
}

}  // namespace

// With e = |phi| - pi/4 and t = tan|e|, gap the near one (of the mirror for phi > 0, else of the light) and other the far one:
//   |phi| <= pi/4:  1 - D = (gap + t other) / (1 + t)        |phi| > pi/4:  1 - D = gap + 2 t / (1 + t) cos_i cos_o
LafortuneAim lafortune_aim(double phi) {
  const double inside = (kMirrorAim - std::abs(phi)) + kQuarterPiRest;
  const double t = std::tan(std::abs(inside)), sign = phi >= 0.0 ? 1.0 : -1.0;
  const double slope = (1.0 + t * t) / ((1.0 + t) * (1.0 + t));
  LafortuneAim aim;
  double other = 0.0;
  if (inside >= 0.0) {
    aim.mirror = 1.0 / (1.0 + t);
    other = t / (1.0 + t);
    aim.gap_slope = slope;
  } else {
    aim.grazing = 2.0 * t / (1.0 + t);
    aim.grazing_slope = 2.0 * sign * slope;
  }
  aim.retro = phi >= 0.0 ? other : aim.mirror;
  if (phi < 0.0) aim.mirror = other;
  return aim;
}

double careful_base(double phi, const LobeGeometry& g) {
  const double gap = phi >= 0.0 ? g.mirror_gap : g.retro_gap, other = phi >= 0.0 ? g.retro_gap : g.mirror_gap;
  DoubleDouble x = exact_sum(kMirrorAim, -std::abs(phi)) + DoubleDouble{kQuarterPiRest, kQuarterPiSecondRest};
  const bool inside = x.high >= 0.0;
  if (!inside) x = -x;
  const auto [sine, cosine] = sine_and_cosine(x);
  const DoubleDouble sum = sine + cosine;
  const DoubleDouble near_part = exact_sum(1.0, -gap);
  const DoubleDouble scaled = inside ? near_part * cosine + exact_sum(1.0, -other) * sine
                                     : near_part * sum + -(sine * exact_product(2.0 * g.cos_i, g.cos_o));
  return scaled.high / sum.high;
}

}  // namespace lumitexel
