// Whether samples ask for a lobe, or are matte.
#pragma once

#include <span>

#include "processing/brdf/error_model.h"
#include "processing/brdf/lafortune.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

// The best diffuse BRDF under the weights that `with_lobe` gives the samples.
LafortuneBrdf diffuse_alone(std::span<const Observation* const> samples, const ErrorModel& error,
                            const LafortuneBrdf& with_lobe);

// The Bayesian information criterion for residuals of unknown variance, n ln(cost) + k ln(n), is lower with the lobe
// and its `parameters` than without. Channels are not counted as separate samples, since their errors go together.
bool lobe_is_needed(std::span<const Observation* const> samples, const ErrorModel& error, const LafortuneBrdf& with_lobe,
                    const LafortuneBrdf& matte, int parameters);

}  // namespace lumitexel
