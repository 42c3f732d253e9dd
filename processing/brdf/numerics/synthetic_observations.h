// Observations with a known truth, as hard or as easy as a case asks for.
#pragma once

#include "processing/brdf/numerics/lobe_trials.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

Brdf shiny_brdf(double diffuse, double peak, double exponent);  // three channels, lightly coloured; one Lafortune lobe at the mirror
// Samples near the mirror direction and away from it in turn; noise: one-sigma relative to the value, independent a channel.
Observation random_sample(const Brdf& truth, double noise, RandomNumbers& random);
Observations random_observations(const Brdf& truth, std::size_t lumitexels, std::size_t samples, double noise, std::uint64_t seed);
std::vector<FitSample> all_samples(const Observations& observations);

}  // namespace lumitexel
