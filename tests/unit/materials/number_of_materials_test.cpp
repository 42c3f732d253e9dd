#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "processing/brdf/cluster_materials.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr double kMirror = 0.7853981633974483;

// Noise of one standard deviation per sample, common to all channels to the given share.
void disturb(Observations& observations, double relative, double common, std::mt19937& random) {
  std::normal_distribution<double> normal;
  for (Observation& sample : observations.samples) {
    const double shared = normal(random);
    for (float& r : sample.reflectance) {
      r *= static_cast<float>(1.0 + relative * (std::sqrt(common) * shared + std::sqrt(1.0 - common) * normal(random)));
    }
  }
}

std::size_t materials_found(const Observations& observations, ErrorSource errors) {
  LumitexelList all(observations.lumitexels());
  std::iota(all.begin(), all.end(), std::size_t{0});
  ClusterOptions options;
  options.materials = 0;
  options.errors = errors;
  options.fit.error = ErrorModel(0.3, 0.02);
  return cluster_materials(observations, all, options, [](int) {}).materials.size();
}

// Each seed takes a second; the 100 seeds are for a campaign.
constexpr unsigned kSeeds = 4;

TEST(NumberOfMaterials, OneMaterialIsOneWhetherChannelsErrTogetherOrApart) {
  for (const double common : {0.0, 0.9}) {
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      std::mt19937 random(seed);
      Observations observations;
      add_lumitexels(observations, one_lobe({0.2, 0.1, 0.05}, {0.6, 0.6, 0.6}, kMirror, 20.0), 150, 6, 0.0, random);
      disturb(observations, 0.05, common, random);
      EXPECT_EQ(materials_found(observations, ErrorSource::Auto), 1u) << "seed " << seed << ", common " << common;
    }
  }
}

TEST(NumberOfMaterials, ThreeAreThree) {
  for (unsigned seed = 0; seed < 2; ++seed) {
    std::mt19937 random(seed);
    Observations observations;
    add_lumitexels(observations, one_lobe({0.20, 0.05, 0.04}, {0.3, 0.3, 0.3}, kMirror, 8.0), 150, 6, 0.05, random);
    add_lumitexels(observations, one_lobe({0.04, 0.06, 0.20}, {1.5, 1.5, 1.5}, kMirror, 60.0), 90, 6, 0.05, random);
    add_lumitexels(observations, one_lobe({0.01, 0.01, 0.01}, {3.0, 2.0, 1.0}, kMirror, 25.0), 60, 6, 0.05, random);
    EXPECT_EQ(materials_found(observations, ErrorSource::Auto), 3u) << seed;
  }
}

}  // namespace
}  // namespace lumitexel
