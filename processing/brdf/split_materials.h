// More materials than wanted, by splitting: the first half of finding them (merge_materials.h is the second). Splitting alone misses
// small materials, and what it parts wrongly stays parted; splitting into too many and merging finds them.
#pragma once

#include <functional>

#include "processing/brdf/mixture.h"

namespace lumitexel {

// Splits where it gains most likelihood, until `most` materials are reached or none gains: along the
// first eigenvector of the material's covariance (eq. 9 of the paper), along the direction in which its lumitexels' brightness and
// colour vary most, or by parting from those that it explains worst. Looks at no more than some thousand samples of a material.
// report: called with the number of materials after each split.
Mixture split_materials(const MaterialFit& whole, const Observations& observations, const LumitexelList& lumitexels, int most,
                        const MaterialFitOptions& options, const std::function<void(int)>& report);

}  // namespace lumitexel
