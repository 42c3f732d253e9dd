// Smooth band-limited noise over space: random gradients on the integer lattice, blended with C2 weights.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace lumitexel {

// Mean 0, rms about 0.25, |value| < 1, features about one unit apart. A function of seed and point alone.
double gradient_noise(const Eigen::Vector3d& point, std::uint64_t seed);

}  // namespace lumitexel
