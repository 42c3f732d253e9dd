// How far a fit is from the truth in directions it was not fitted to.
#pragma once

#include <span>

#include "processing/brdf/nearest_material.h"

namespace lumitexel {

// Root mean square of the differences of f cos_i over all channels, relative to the root mean square of the truth: as it is, with truth and fit clipped at
// the truth's 99.9th percentile, and of square roots.
struct RelativeErrors {
  double raw = 0, clipped = 0, roots = 0;
};
RelativeErrors relative_errors(const BrdfValues& truth, const BrdfValues& fit, std::span<const LobeGeometry> directions);

// q from 0 to 1, of a copy; NaN for none.
double quantile(std::vector<double> values, double q);

}  // namespace lumitexel
