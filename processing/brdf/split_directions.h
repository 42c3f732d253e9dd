// Two ways to part one material's BRDF into two that its members may choose between.
#pragma once

#include <utility>
#include <vector>

#include "processing/brdf/cluster_materials.h"

namespace lumitexel {

using BrdfPair = std::pair<LafortuneBrdf, LafortuneBrdf>;

// Eq. 9 of the paper: the parameters moved both ways along the first eigenvector of their covariance. The step is
// long enough to matter (a quarter in kd, peak or exponent), since the covariance itself shrinks with every sample.
BrdfPair split_along_covariance(const FittedMaterial& material, bool shared_shape);

// The whole BRDF scaled per channel both ways along the first principal component of how much brighter
// each member is, per channel, than the material says.
BrdfPair split_along_brightness(const FittedMaterial& material, const Observations& observations,
                                const std::vector<std::size_t>& members, const ErrorModel& error);

}  // namespace lumitexel
