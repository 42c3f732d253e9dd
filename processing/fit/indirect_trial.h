// The trial whether light between surfaces is to be taken out of the samples (indirect_worth.h).
//
// A model fitted to the samples as photographed has taken up that light where it goes with a lumitexel's own reflection. What goes
// otherwise with the lamp is left in its residuals, and there the predicted light is sought: of both, what a factor on the lumitexel's
// prediction would explain is taken away, channel by channel, and what remains of the residuals is regressed on what remains of the light, by the
// given error model with outliers counting less. Predicted light scatters, as few paths find it (on oracle_a most of what differs between a
// lumitexel's samples); by how much is known, and does not count as light.
// Fits have taken up more than a factor, which makes the slope too small; bounces that nobody follows make it too large. It is asked on the mesh's
// normals, before others are fitted: a second time would cost all that follows once more.
#pragma once

#include <vector>

#include "processing/brdf/error_model.h"
#include "processing/brdf/observations.h"
#include "processing/brdf/project_weights.h"
#include "processing/fit/indirect_worth.h"
#include "processing/model/model.h"

namespace lumitexel {

// before: samples as photographed, with their views, which `model`'s last functions and `weights` were fitted to. without: the same samples less
// the predicted light, each with the variance of its own paths added; lumitexels whose samples are not as many are left out. label, weights: of each lumitexel. The
// same bits for any number of threads.
IndirectWorth try_without_indirect(const Observations& before, const Observations& without, const Model& model, const std::vector<int>& label,
                                   const std::vector<TexelWeights>& weights, const ErrorModel& error);

}  // namespace lumitexel
