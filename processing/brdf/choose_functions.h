// Whether a material's basis BRDFs are moved to fit (principal_functions.h): only where lumitexels that they were not moved to are then predicted
// better. The paper moves them always.
#pragma once

#include <vector>

#include "processing/brdf/choice.h"
#include "processing/brdf/principal_functions.h"

namespace lumitexel {

struct FunctionsChoice {
  bool moved = false;
  Gain gain;  // of functions moved to every other member, over the basis as it came, on the members between
};

// options.prior: on the texels' weights while functions move; the others are projected by the prior that left-out samples choose for each basis.
// Moved if worth_having (choice.h). members: lumitexels of the material.
FunctionsChoice choose_functions(const Observations& observations, const LumitexelList& members, const std::vector<Brdf>& basis,
                                 const MaterialModel& material, const PrincipalOptions& options, Precision precision);

}  // namespace lumitexel
