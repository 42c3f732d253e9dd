// The fits at the extremes: what they are given, and how far the answer may be off.
#pragma once

#include <cstddef>

#include "processing/brdf/numerics/numeric_case.h"

namespace lumitexel {

// Errors are of the predicted reflectance, relative to max(truth, its largest / 1000), unless the row says otherwise.
NumericCases fit_cases();
// Rank-deficient systems and collinear bases.
NumericCases rank_cases();
// One lumitexel, and `lumitexels` of two materials.
NumericCases extent_cases(std::size_t lumitexels);

}  // namespace lumitexel
