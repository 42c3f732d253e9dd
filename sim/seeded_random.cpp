#include "sim/seeded_random.h"

#include <bit>
#include <cmath>
#include <numbers>

namespace lumitexel {
namespace {

constexpr std::uint64_t kGoldenGamma = 0x9e3779b97f4a7c15ull;
constexpr double kGaussianFrom = 50.0;

}  // namespace

std::uint64_t scrambled(std::uint64_t bits) {
  bits = (bits ^ (bits >> 30)) * 0xbf58476d1ce4e5b9ull;
  bits = (bits ^ (bits >> 27)) * 0x94d049bb133111ebull;
  return bits ^ (bits >> 31);
}

std::uint64_t extended_key(std::uint64_t key, std::uint64_t word) {
  return scrambled(scrambled(key + kGoldenGamma) ^ (word * kGoldenGamma));
}

std::uint64_t extended_key(std::uint64_t key, double word) {
  return extended_key(key, std::bit_cast<std::uint64_t>(word + 0.0));
}

double CounterRandom::uniform() {
  state_ += kGoldenGamma;
  return (static_cast<double>(scrambled(state_) >> 12) + 0.5) * 0x1p-52;
}

double CounterRandom::normal() {
  const double radius = std::sqrt(-2.0 * std::log(uniform()));
  return radius * std::cos(2.0 * std::numbers::pi * uniform());
}

double CounterRandom::poisson(double mean) {
  if (mean <= 0.0) return 0.0;
  if (mean > kGaussianFrom) {
    const double drawn = std::round(mean + std::sqrt(mean) * normal());
    return drawn > 0.0 ? drawn : 0.0;
  }
  // Inversion: walk up the cumulative distribution. The bound only guards against rounding in the far tail.
  constexpr int kFarTail = 200;
  double probability = std::exp(-mean), remaining = uniform() - probability;
  int count = 0;
  while (remaining > 0.0 && count < kFarTail) {
    ++count;
    probability *= mean / count;
    remaining -= probability;
  }
  return count;
}

}  // namespace lumitexel
