// Principal function analysis (section 8.2 of the paper, eq. 13): the basis BRDFs of a material themselves moved so that the mixtures
// of its texels explain their samples best.
#pragma once

#include "processing/brdf/fit_material.h"
#include "processing/brdf/mixture.h"
#include "processing/brdf/project_weights.h"

namespace lumitexel {

struct PrincipalOptions {
  int functions = 3;                     // so many of the basis, from its front, are moved
  std::size_t most_lumitexels = 2000;    // of the members that the functions are learnt from
  int draw = 0;                          // which of them (draw_phase.h)
  int max_iterations = 12;
  TexelPrior prior;                      // on the texels' weights
  MaterialFitOptions fit;                // lobes, channels' shapes and bounds
};

struct PrincipalFunctions {
  std::vector<Brdf> basis;
  double cost_before = 0, cost_after = 0;  // weighted squares plus the prior's, per lumitexel
  int iterations = 0;
};

// Minimises, by Levenberg-Marquardt over the functions' parameters, the cost after projection: inside each step every lumitexel's weights
// are solved anew (non-negative, with the prior). Samples are weighted by the error model at basis[0] as it came.
PrincipalFunctions principal_functions(const Observations& observations, const LumitexelList& members, const std::vector<Brdf>& basis,
                                       const ErrorModel& error, const PrincipalOptions& options);

}  // namespace lumitexel
