// All normals of an object together: what samples say of each, how far each may be from the coarse mesh's, and that neighbours deviate
// from it alike. Gauss-Newton over the whole surface; the linear system, two unknowns a lumitexel, by conjugate gradients.
//
//   minimise  sum_i misfit_i(n_i, w_i) + |d_i|^2 / coarse_sigma^2 + sum_(ij) rho(|d_i - d_j|^2 / neighbour_sigma^2)
//            + sum_loops (curl / curl_sigma)^2,      d_i = n_i - coarse_i
//
// rho is Student's, so that an edge costs little more than a steep slope. Where samples say nothing the neighbours decide; where they say
// much, they do.
#pragma once

#include <functional>

#include "processing/normals/normal_problem.h"

namespace lumitexel {

struct SmoothNormalOptions {
  NormalPrior prior;
  int steps = 6;
  double largest_step_rad = 0.06;
};

struct NormalField {
  std::vector<Eigen::Vector3d> normal;  // in world, unit
  std::vector<TexelWeights> weights;
};

// Every normal as the mesh has it, every texel its material's own BRDF: where the search starts.
NormalField field_on_mesh(const NormalProblem& problem);

// From `start`; weights follow the normals in every step. Normals stay where every photograph that gave a sample can see them.
NormalField smooth_normals(const NormalProblem& problem, NormalField start, const SmoothNormalOptions& options,
                           const std::function<void(int)>& after_step = [](int) {});

// What is minimised.
double normal_objective(const NormalProblem& problem, const NormalField& field, const NormalPrior& prior);

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
