// Basis functions are moved where texels ask for it, and not where the basis is right already (choose_functions.h).
#include "processing/brdf/choose_functions.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/parallel_for.h>

#include <atomic>
#include <cmath>
#include <numeric>

#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr int kSeeds = 100, kWanted = 95;
constexpr int kTexels = 120, kSamples = 8;
constexpr double kNoise = 0.05;

// The material, and what its texels mix with it.
const std::vector<Brdf> kTruth{one_lobe({0.10, 0.06, 0.05}, {0.6, 0.6, 0.6}, kMirrorAim, 20.0),
                               one_lobe({0.03, 0.04, 0.15}, {0.2, 0.2, 0.2}, kMirrorAim, 80.0)};

Observations texels_of(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> own(0.7, 1.3), other(0.0, 0.8);
  Observations observations;
  for (int i = 0; i < kTexels; ++i) {
    const double a = own(random), b = other(random);
    const std::size_t before = observations.samples.size();
    add_lumitexels(observations, kTruth[0], 1, kSamples, 0.0, random);
    for (std::size_t s = before; s < observations.samples.size(); ++s) {
      Observation& sample = observations.samples[s];
      const ChannelValues first = predicted_reflectance(kTruth[0], sample.geometry), second = predicted_reflectance(kTruth[1], sample.geometry);
      for (std::size_t c = 0; c < 3; ++c) sample.reflectance[c] = static_cast<float>((a * first[c] + b * second[c]) * (1.0 + kNoise * normal(random)));
    }
  }
  return observations;
}

int seeds_that_move(const std::vector<Brdf>& basis) {
  std::atomic<int> moved = 0;
  oneapi::tbb::parallel_for(1, kSeeds + 1, [&](int seed) {
    const Observations observations = texels_of(static_cast<unsigned>(seed));
    LumitexelList members(observations.lumitexels());
    std::iota(members.begin(), members.end(), std::size_t{0});
    PrincipalOptions options;
    options.prior = {0.5, 0.5};  // as wide as texels of this kind differ
    if (choose_functions(observations, members, basis, {basis[0], ErrorModel(kNoise, 1e-3)}, options, Precision::Double).moved) ++moved;
  });
  testing::Test::RecordProperty("seeds_of_100", moved);
  return moved;
}

TEST(FunctionsChoice, WhatTexelsMixAlreadyStaysAsItIs) { EXPECT_LE(seeds_that_move(kTruth), kSeeds - kWanted); }

// The other function has half of the highlight's exponent and another colour.
TEST(FunctionsChoice, AFunctionThatNoTexelMixesIsMoved) {
  EXPECT_GE(seeds_that_move({kTruth[0], one_lobe({0.10, 0.04, 0.03}, {0.2, 0.2, 0.2}, kMirrorAim, 40.0)}), kWanted);
}

}  // namespace
}  // namespace lumitexel
