// Draws 0, 1, 2, ... of evenly spread lumitexels: what fits to several of them differ by is chance.
#pragma once

#include <cmath>

namespace lumitexel {

// Where a draw begins between one lumitexel chosen and the next, in [0, 1); draw 0 at 0. Multiples of the golden ratio, which lie far from
// each other however many there are.
inline double draw_phase(int draw) {
  constexpr double kGoldenRatio = 0.6180339887498949;
  const double turns = kGoldenRatio * static_cast<double>(draw);
  return turns - std::floor(turns);
}

}  // namespace lumitexel
