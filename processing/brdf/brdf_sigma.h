// How surely samples determine a BRDF: one sigma of each of its numbers.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "processing/brdf/brdf.h"

namespace lumitexel {

class BrdfParameters;

// NaN: no sample sees it, or it stands at a bound. Of logarithms a sigma is a share of the number itself.
struct LobeSigma {
  double log_strength = 0, log_shape = 0, aim = 0;  // aim: radians; NaN where the family does not aim
};

// Laid out as the Brdf is. What errs alike in all samples, such as wrong normals or a wrong lamp, comes on top.
struct BrdfSigma {
  std::array<double, kMaxChannels> diffuse{};  // 1/sr
  std::vector<std::array<LobeSigma, kMaxChannels>> lobes;
};

// covariance: of the parameters, as fit_brdf.h states it.
BrdfSigma sigma_of(const Eigen::MatrixXd& covariance, const BrdfParameters& parameters);

}  // namespace lumitexel
