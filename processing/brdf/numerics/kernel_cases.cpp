#include "processing/brdf/numerics/kernel_cases.h"

#include "processing/brdf/numerics/lobe_trials.h"

namespace lumitexel {
namespace {

constexpr double kValueLimit = 2.5e-13, kSlopeLimit = 2.5e-12, kFacetLimit = 1e-14;
constexpr double kPeakShare = 1e-3;
constexpr double kLeastBase = 1e-17;  // what is left of it under 1e-32, the end of a pair of doubles, is 15 digits

double distance(Quad reference, double value) { return static_cast<double>(reference - static_cast<Quad>(value)); }

double top_of(BrdfFamily family, const LobeTrial& lobe, const LobeGeometry& geometry) {
  if (family == BrdfFamily::Lafortune) return 1.0;
  QuadGeometry on_normal = as_stored(geometry);
  on_normal.across2 = 0;
  const QuadSlopes top = reference_slopes(family, lobe.log_shape, lobe.aim, on_normal);
  return static_cast<double>(top.gain + top.offset);
}

struct Errors {
  LargestError value, slope;

  void see(BrdfFamily family, const LobeTrial& lobe, const LobeGeometry& geometry, const QuadGeometry& truth) {
    const QuadSlopes wanted = reference_slopes(family, lobe.log_shape, lobe.aim, truth);
    const LobeSlopes got = lobe_family(family).slopes(lobe.log_shape, lobe.aim, geometry);
    const double scale = std::max(static_cast<double>(wanted.gain + wanted.offset), kPeakShare * top_of(family, lobe, geometry));
    value.see(distance(wanted.gain, got.gain) / scale);
    value.see(distance(wanted.offset, got.offset) / scale);
    const auto see_slope = [&](Quad reference, double found) {
      slope.see(distance(reference, found) / std::max(scale, std::abs(static_cast<double>(reference))));
    };
    see_slope(wanted.gain_by_shape, got.gain_by_shape);
    see_slope(wanted.offset_by_shape, got.offset_by_shape);
    see_slope(wanted.gain_by_aim, got.gain_by_aim);
  }
};

struct Range {
  ShapeRange shape;
  const char* text;
};
constexpr Range kExponents[] = {{{0.01, 1.0}, "N 0.01 to 1"}, {{1.0, 100.0}, "N 1 to 100"}, {{100.0, 1e4}, "N 100 to 1e4"}, {{1e4, 1e5}, "N 1e4 to 1e5"}};
constexpr Range kAlphas{{1e-3, 1.0}, "alpha 0.001 to 1"};

void add_family(BrdfFamily family, const Range& range, double value_limit, double slope_limit, std::size_t trials, NumericCases& cases) {
  RandomNumbers random(1);
  Errors errors;
  for (std::size_t i = 0; i < trials; ++i) {
    const LobeTrial lobe = random_lobe(family, range.shape, random);
    const LobeGeometry geometry = rounded_geometry(random_directions(family, lobe, random));
    errors.see(family, lobe, geometry, as_stored(geometry));
  }
  const std::string name = std::string(to_string(family)) + " double, " + range.text;
  cases.push_back({name, "value, to 89.99 degrees", errors.value.value(), value_limit});
  cases.push_back({name, "slopes, to 89.99 degrees", errors.slope.value(), slope_limit});
}

void add_small_base(std::size_t trials, NumericCases& cases) {
  RandomNumbers random(2);
  Errors errors;
  std::size_t excluded = 0;
  for (std::size_t i = 0; i < trials; ++i) {
    LobeTrial lobe = random_lobe(BrdfFamily::Lafortune, {0.01, 4.0}, random);
    const DirectionPair pair = random_directions(BrdfFamily::Lafortune, lobe, random);
    if (!aim_at_small_base(pair, random, lobe.aim)) continue;
    const LobeGeometry geometry = rounded_geometry(pair);
    const double power = static_cast<double>(reference_slopes(BrdfFamily::Lafortune, lobe.log_shape, lobe.aim, as_stored(geometry)).gain);
    if (power > 0.0 && std::log(power) < std::log(kLeastBase) * std::exp(lobe.log_shape)) {
      ++excluded;
      continue;
    }
    errors.see(BrdfFamily::Lafortune, lobe, geometry, as_stored(geometry));
  }
  const std::string name = "lafortune double, base 1e-17 to 0.1, at and below zero";
  const std::string because = excluded == 0 ? "" : "the base came out above zero and below 1e-17, where a pair of doubles, which ends at 1e-32, leaves it under 15 digits";
  cases.push_back({name, "value, N 0.01 to 4", errors.value.value(), kValueLimit, excluded, because});
  cases.push_back({name, "slopes, N 0.01 to 4", errors.slope.value(), kSlopeLimit, excluded, because});
}

// What making a geometry of doubles costs: reference from exact directions.
void add_geometry(std::size_t trials, NumericCases& cases) {
  RandomNumbers random(3);
  Errors errors;
  for (std::size_t i = 0; i < trials; ++i) {
    const LobeTrial lobe = random_lobe(BrdfFamily::Lafortune, {10.0, 1e5}, random);
    const DirectionPair pair = random_directions(BrdfFamily::Lafortune, lobe, random);
    errors.see(BrdfFamily::Lafortune, lobe, rounded_geometry(pair), exact_geometry(pair));
  }
  cases.push_back({"lafortune double from rounded directions, N 10 to 1e5", "value against exact directions", errors.value.value(), kValueLimit});
}

// evaluate() with strength and diffuse part, N and peak at random.
void add_peaks(std::size_t trials, NumericCases& cases) {
  RandomNumbers random(4);
  LargestError error;
  for (std::size_t i = 0; i < trials; ++i) {
    const LobeTrial lobe = random_lobe(BrdfFamily::Lafortune, {0.01, 1e5}, random);
    const LobeGeometry geometry = rounded_geometry(random_directions(BrdfFamily::Lafortune, lobe, random));
    Brdf brdf{BrdfFamily::Lafortune, 1, {}, std::vector<std::array<Lobe, kMaxChannels>>(1)};
    brdf.lobes[0].fill({lobe.log_strength, lobe.log_shape, lobe.aim});
    const double peak = std::exp(lobe.log_strength);
    const QuadSlopes wanted = reference_slopes(BrdfFamily::Lafortune, lobe.log_shape, lobe.aim, as_stored(geometry));
    error.see(distance(wanted.gain * static_cast<Quad>(peak), evaluate(brdf, 0, geometry)) /
              (peak * std::max(static_cast<double>(wanted.gain), kPeakShare)));
  }
  cases.push_back({"lafortune double, peaks 1e-6 to 1e6", "value, N 0.01 to 1e5", error.value(), kValueLimit});
}

}  // namespace

NumericCases double_kernel_cases(std::size_t trials) {
  NumericCases cases;
  for (const Range& range : kExponents) add_family(BrdfFamily::Lafortune, range, kValueLimit, kSlopeLimit, trials, cases);
  add_small_base(trials, cases);
  add_peaks(trials, cases);
  add_geometry(trials, cases);
  add_family(BrdfFamily::Ggx, kAlphas, kFacetLimit, 10.0 * kFacetLimit, trials, cases);
  add_family(BrdfFamily::Ward, kAlphas, kFacetLimit, 10.0 * kFacetLimit, trials, cases);
  return cases;
}

}  // namespace lumitexel
