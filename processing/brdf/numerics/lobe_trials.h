// Lobes and directions at random, dense where kernels lose digits: within a lobe's width of the mirror direction and of the light, at
// grazing angles to 89.99 degrees, and at aims where the base of the power is near zero.
#pragma once

#include <cstdint>

#include "processing/brdf/numerics/reference_lobes.h"

namespace lumitexel {

class RandomNumbers {  // the same on every platform
 public:
  explicit RandomNumbers(std::uint64_t seed) : state_(seed) {}
  double uniform();                           // in [0, 1)
  double uniform(double least, double most) { return least + (most - least) * uniform(); }
  double normal();                            // mean 0, variance 1
  std::uint64_t bits();

 private:
  std::uint64_t state_;
};

struct ShapeRange {
  double least = 0, most = 0;  // N of Lafortune, alpha of the others
};

struct LobeTrial {
  double log_shape = 0, aim = 0, log_strength = 0;  // strength 1e-6 to 1e6
};
LobeTrial random_lobe(BrdfFamily family, const ShapeRange& shape, RandomNumbers& random);
// Both directions above the surface.
DirectionPair random_directions(BrdfFamily family, const LobeTrial& lobe, RandomNumbers& random);
// An aim whose base is 10^-k at these directions, k from 1 to 17, or zero or below; false where no aim within bounds does that.
bool aim_at_small_base(const DirectionPair& pair, RandomNumbers& random, double& aim);

}  // namespace lumitexel
