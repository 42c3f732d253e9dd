// Lumitexels with known truth: random lights and views over a flat patch, reflectance from given BRDFs.
#pragma once

#include <random>

#include "processing/brdf/observations.h"

namespace lumitexel {

Brdf one_lobe(std::array<double, 3> diffuse, std::array<double, 3> peak, double phi, double exponent);

// `count` more lumitexels with `samples` samples each, half of which lie near the mirror direction so that the lobe is seen;
// noise: standard deviation relative to the value.
void add_lumitexels(Observations& observations, const Brdf& truth, int count, int samples, double noise,
                    std::mt19937& random);

}  // namespace lumitexel
