// How well a mixture's materials predict samples that a texel was not shown, once each texel has its own mixture of them, much as in the finished
// model (project_weights.h; that one may have fewer functions, more lobes, no prior). Left out of the choice of its material and of its weights;
// materials have learnt, and priors were chosen, from other lumitexels, where there are enough.
#pragma once

#include "processing/brdf/left_out_error.h"
#include "processing/brdf/left_out_folds.h"

namespace lumitexel {

// One entry for each of `asked`, summed over its samples: every fourth at a time is predicted from the others, by the most probable material's
// basis (material_basis.h, without neighbours on the surface) and a prior that `learners` say (choose_prior). Lumitexels with one sample count as zero.
// clip: as of left_out_errors. The same bits for any number of threads.
std::vector<SquaredError> projected_errors(const Mixture& mixture, const Observations& observations, const LumitexelList& learners,
                                           const LumitexelList& asked, double clip);

// The same for whole photographs: each lumitexel's samples in `left_out` (left_out_folds.h) are predicted from those that it has in `shown`, by
// materials that have learnt from `shown` alone. One entry for each of so many photographs, by Observations::view. learners, asked: of both.
std::vector<SquaredError> projected_errors_by_photograph(const Mixture& mixture, const PhotographFold& fold, const LumitexelList& learners,
                                                         const LumitexelList& asked, std::size_t photographs, double clip);

}  // namespace lumitexel
