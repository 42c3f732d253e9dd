// All normals of an object together: what samples say of each, how far each may be from the coarse mesh's, and that neighbours deviate
// from it alike. Levenberg-Marquardt over the whole surface.
//
//   minimise  E = sum_i misfit_i(n_i, w_i) + |d_i|^2 / coarse_sigma^2 + sum_(ij) rho(|d_i - d_j|^2 / neighbour_sigma^2)
//                 + sum_loops (curl / curl_sigma)^2,      d_i = n_i - coarse_i
//
// rho is Student's, so that an edge costs little more than a steep slope. Where samples say nothing the neighbours decide; where they say
// much, they do. Samples' scales follow the prediction from step to step, and stand still within one (normal_cost).
#pragma once

#include <functional>

#include "processing/normals/normal_problem.h"

namespace lumitexel {

struct SmoothNormalOptions {
  NormalPrior prior;
  int most_steps;                  // it stops earlier, when a step gains next to nothing
  double largest_step_rad = 0.06;  // of one normal: half a lobe of exponent 100, beyond which slopes say little
};

// Every normal as the mesh has it, every texel its material's own BRDF: where the search starts.
NormalField field_on_mesh(const NormalProblem& problem);

// From `start`; weights follow the normals in every step, and no step raises E. Normals stay where every photograph that gave a sample can see them.
// after_step: called with the steps taken.
NormalField smooth_normals(const NormalProblem& problem, NormalField start, const SmoothNormalOptions& options,
                           const std::function<void(int)>& after_step = [](int) {});

// E, samples scaled as `scaled_by` predicts them.
double normal_objective(const NormalProblem& problem, const NormalField& field, const NormalField& scaled_by, const NormalPrior& prior);

}  // namespace lumitexel
