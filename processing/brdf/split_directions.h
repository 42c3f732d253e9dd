// Two ways to part one material's BRDF into two that its members may choose between.
#pragma once

#include <utility>
#include <vector>

#include "processing/brdf/brdf_parameters.h"
#include "processing/brdf/error_model.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

using BrdfPair = std::pair<Brdf, Brdf>;

// Eq. 9 of the paper: the parameters (of `layout`) moved both ways along the first eigenvector of their covariance. The step is
// long enough to matter (a quarter in kd, strength or shape), since the covariance itself shrinks with every sample.
BrdfPair split_along_covariance(const Brdf& brdf, const Eigen::MatrixXd& covariance, const BrdfParameters& layout);

// The whole BRDF scaled per channel both ways along the first principal component of how much brighter
// each member is, per channel, than the material says.
BrdfPair split_along_brightness(const Brdf& brdf, const Observations& observations, const std::vector<std::size_t>& members,
                                const ErrorModel& error);

}  // namespace lumitexel
