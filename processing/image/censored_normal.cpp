#include "processing/image/censored_normal.h"

#include <cmath>
#include <numbers>

namespace lumitexel {

double log_cdf_slope(double a) {
  if (a < -30.0) return -a - 1.0 / a;  // its limit; the distribution would underflow
  const double density = std::exp(-0.5 * a * a) / std::sqrt(2.0 * std::numbers::pi);
  return density / (0.5 * std::erfc(-a / std::numbers::sqrt2));
}

double log_cdf(double a) {
  // Far below, the distribution is the density over its own slope.
  if (a < -30.0) return -0.5 * a * a - std::log(-a * std::sqrt(2.0 * std::numbers::pi));
  return std::log(0.5 * std::erfc(-a / std::numbers::sqrt2));
}

}  // namespace lumitexel
