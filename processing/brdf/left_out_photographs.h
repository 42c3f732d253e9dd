// Whether a richer BRDF predicts photographs that it was not fitted to. Samples of one photograph err together, where its pose, its shadows
// or the mesh's normals under its light are off: a lobe can explain that as well as a highlight, by any count of samples, and then points
// where other photographs find nothing.
#pragma once

#include <cstddef>

#include "processing/brdf/fit_material.h"

namespace lumitexel {

inline constexpr std::size_t kPhotographFolds = 4;

// Photographs are left out by turns, every fourth at a time, each once; both models are fitted to the others, the richer one's
// further lobes sought anew, and compared by their misfit under the richer one's error model. True if the richer one's is less by more than
// one standard error over photographs, and where there are fewer than two photographs to ask. A highlight in one photograph alone is refused.
bool predicts_other_photographs(const MaterialModel& smaller, const MaterialModel& richer, FitSamples samples, const MaterialFitOptions& options);

}  // namespace lumitexel
