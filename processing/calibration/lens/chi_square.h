// Chi square by the cube-root approximation (Wilson, Hilferty 1931): exact to some 0.02 standard deviations.
#pragma once

#include <algorithm>
#include <cmath>

namespace lumitexel {

// The value that chi square of so many degrees exceeds as seldom as a Gaussian exceeds z standard deviations.
inline double chi2_bound(double degrees, double z) {
  const double spread = 2.0 / (9.0 * degrees), root = std::max(0.0, 1.0 - spread + z * std::sqrt(spread));
  return degrees * root * root * root;
}

// The other way round: the z of a value.
inline double chi2_z(double value, double degrees) {
  const double spread = 2.0 / (9.0 * degrees);
  return (std::cbrt(value / degrees) - 1.0 + spread) / std::sqrt(spread);
}

}  // namespace lumitexel
