// BRDFs with known parameters and noisy lumitexels of them.
#pragma once

#include <random>
#include <vector>

#include "processing/brdf/fit_material.h"
#include "processing/brdf/observations.h"

namespace lumitexel {

struct KnownLobe {
  double strength = 0.05, shape = 0.2, aim = kMirrorAim;
};
// Diffuse light 0.2, 0.15, 0.1 and these lobes, a little stronger from channel to channel.
Brdf known_brdf(BrdfFamily family, const std::vector<KnownLobe>& lobes);

// How noise goes together: each value for itself, channels of a sample with a correlation of 0.9, or
// half of the variance common to all of a lumitexel's samples.
enum class NoiseKind { Independent, ChannelsTogether, LumitexelTogether };

struct NoisySamples {
  std::vector<Observation> observations;
  std::vector<FitSample> samples;  // point into observations
};

// `lumitexels` of five samples, two of which lie near the mirror direction; noise relative to the value, Gaussian.
NoisySamples noisy_samples(const Brdf& truth, int lumitexels, double noise, NoiseKind kind, unsigned seed);

// Directions that a rig covers, without noise.
std::vector<LobeGeometry> some_directions(int count, unsigned seed);

}  // namespace lumitexel
