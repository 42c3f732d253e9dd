#include "processing/brdf/numerics/lobe_trials.h"

#include <algorithm>
#include <cmath>

namespace lumitexel {
namespace {

constexpr double kPi = 3.141592653589793, kMostTheta = 1.570621793869697;  // 89.99 degrees

double log_uniform(double least, double most, RandomNumbers& random) {
  return std::exp(random.uniform(std::log(least), std::log(most)));
}

double random_aim(RandomNumbers& random) {
  const double side = random.uniform() < 0.7 ? 1.0 : -1.0;
  switch (random.bits() % 4) {
    case 0: return side * kMirrorAim;
    case 1: return side * kMirrorAim + random.uniform(-0.5, 0.5) * log_uniform(1e-12, 1.0, random);
    default: return random.uniform(-0.5 * kPi, 0.5 * kPi);
  }
}

}  // namespace

std::uint64_t RandomNumbers::bits() {  // splitmix64
  std::uint64_t z = state_ += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

double RandomNumbers::uniform() { return static_cast<double>(bits() >> 11) * 0x1p-53; }

double RandomNumbers::normal() {
  double sum = -6.0;
  for (int i = 0; i < 12; ++i) sum += uniform();
  return sum;
}

LobeTrial random_lobe(BrdfFamily family, const ShapeRange& shape, RandomNumbers& random) {
  LobeTrial lobe;
  lobe.log_shape = std::log(log_uniform(shape.least, shape.most, random));
  lobe.aim = family == BrdfFamily::Lafortune ? random_aim(random) : kMirrorAim;
  lobe.log_strength = std::log(log_uniform(1e-6, 1e6, random));
  return lobe;
}

DirectionPair random_directions(BrdfFamily family, const LobeTrial& lobe, RandomNumbers& random) {
  const double shape = std::exp(lobe.log_shape);
  const double width = family == BrdfFamily::Lafortune ? 4.0 / std::sqrt(shape + 1.0) : 6.0 * shape;
  const auto near = [&](double angle) { return angle + random.uniform(-width, width) * log_uniform(1e-3, 1.0, random); };
  DirectionPair pair;
  pair.theta_i = kMostTheta * (random.uniform() < 0.5 ? random.uniform() : 1.0 - log_uniform(1e-4, 1.0, random));
  switch (random.bits() % 4) {
    case 0: pair = {pair.theta_i, random.uniform(0.0, kMostTheta), random.uniform(0.0, 2.0 * kPi)}; break;
    case 1: pair = {pair.theta_i, near(pair.theta_i), near(kPi)}; break;
    case 2: pair = {pair.theta_i, near(pair.theta_i), near(0.0)}; break;
    default: pair = {pair.theta_i, near(pair.theta_i), kPi}; break;
  }
  pair.theta_o = std::clamp(pair.theta_o, 0.0, kMostTheta);
  return pair;
}

// The base vanishes at tan(phi) = p / q with p = cos_i cos_o and q the tangential parts' product.
bool aim_at_small_base(const DirectionPair& pair, RandomNumbers& random, double& aim) {
  const double p = std::cos(pair.theta_i) * std::cos(pair.theta_o);
  const double q = std::sin(pair.theta_i) * std::sin(pair.theta_o) * std::cos(pair.azimuth);
  if (!(std::abs(q) > 1e-6)) return false;
  const double side = random.uniform() < 0.7 ? -1.0 : 1.0;  // above zero, or below
  aim = std::atan(p / q);
  aim += side * (q > 0.0 ? 1.0 : -1.0) * std::pow(10.0, -random.uniform(1.0, 17.0)) * std::max(p, 1e-3);
  return std::abs(aim) < 0.5 * kPi;
}

}  // namespace lumitexel
