// Whether a mixture's errors end more abruptly than the normal distribution has it, and how abruptly (noise_shape.h).
#pragma once

#include "processing/brdf/mixture.h"

namespace lumitexel {

// The likeliest shape of all materials' errors together, or the normal distribution where no other lowers the Bayesian information
// criterion, tempered by independence as in fit_material.h, or where a material's errors have Student's tails: errors cannot have both
// heavy tails and an edge.
NoiseShape choose_noise_shape(const Mixture& mixture, const Observations& observations, const LumitexelList& lumitexels,
                              const Responsibilities& responsibilities);

}  // namespace lumitexel
