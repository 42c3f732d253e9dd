#include "sim/gradient_noise.h"

#include <cmath>

#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

// The dot product of a lattice point's random unit gradient with the offset from it.
double corner(std::int64_t x, std::int64_t y, std::int64_t z, const Eigen::Vector3d& offset, std::uint64_t seed) {
  constexpr std::uint64_t kMask = (1u << 21) - 1;
  const std::uint64_t packed = (static_cast<std::uint64_t>(x) & kMask) | (static_cast<std::uint64_t>(y) & kMask) << 21 |
                               (static_cast<std::uint64_t>(z) & kMask) << 42;
  const std::uint64_t bits = scrambled(packed ^ seed);
  const auto signed_unit = [](std::uint64_t b) { return static_cast<double>(b & kMask) / (0.5 * kMask) - 1.0; };
  Eigen::Vector3d gradient(signed_unit(bits), signed_unit(bits >> 21), signed_unit(bits >> 42));
  return gradient.dot(offset) / (gradient.norm() + 1e-9);
}

double fade(double t) { return t * t * t * (t * (t * 6.0 - 15.0) + 10.0); }

}  // namespace

double gradient_noise(const Eigen::Vector3d& point, std::uint64_t seed) {
  const Eigen::Vector3d base = point.array().floor();
  const Eigen::Vector3d inside = point - base;
  const std::uint64_t lattice_seed = scrambled(seed + 1);
  double sum = 0.0;
  for (int dz = 0; dz < 2; ++dz) {
    for (int dy = 0; dy < 2; ++dy) {
      for (int dx = 0; dx < 2; ++dx) {
        const double weight = (dx ? fade(inside.x()) : 1.0 - fade(inside.x())) *
                              (dy ? fade(inside.y()) : 1.0 - fade(inside.y())) *
                              (dz ? fade(inside.z()) : 1.0 - fade(inside.z()));
        sum += weight * corner(static_cast<std::int64_t>(base.x()) + dx, static_cast<std::int64_t>(base.y()) + dy,
                               static_cast<std::int64_t>(base.z()) + dz, inside - Eigen::Vector3d(dx, dy, dz),
                               lattice_seed);
      }
    }
  }
  return sum;
}

}  // namespace lumitexel
