// How sure fitted normals are.
#pragma once

#include <cstdint>

#include "processing/normals/normal_problem.h"

namespace lumitexel {

// One sigma of each normal per tangent axis, radians, in its two parts: what the samples' errors do to it, and what the prior leaves open
// where samples say little. Both are independent: the whole is the root of their squares' sum.
//
// From kSigmaDraws draws of each part about the field as the linearised problem has it, the same draws every time. With H = J + P, the samples'
// information and the prior's, a draw of either part is what H solves a right side to whose covariance is J or P; together they are draws
// of the posterior.
struct NormalSigmas {
  std::vector<float> samples_rad, prior_rad;
};
inline constexpr std::uint64_t kSigmaDraws = 8;  // a sigma from 16 numbers is known to 18 %
// The deviations, in world, that one draw of the prior leaves: of another fit to the same lumitexels they are what the same surface, off the
// mesh by the same amount, leaves there.
using PriorDraw = std::vector<Eigen::Vector3d>;
// draws: where not null, gets the draws of the prior's part.
NormalSigmas normal_sigmas(const NormalProblem& problem, const NormalField& field, const NormalPrior& prior, std::vector<PriorDraw>* draws = nullptr);

}  // namespace lumitexel
