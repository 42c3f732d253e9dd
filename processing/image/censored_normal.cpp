#include "processing/image/censored_normal.h"

#include <cmath>
#include <numbers>

namespace lumitexel {

double log_cdf_slope(double a) {
  if (a < -30.0) return -a;  // its limit; the distribution would underflow
  const double density = std::exp(-0.5 * a * a) / std::sqrt(2.0 * std::numbers::pi);
  return density / (0.5 * std::erfc(-a / std::numbers::sqrt2));
}

}  // namespace lumitexel
