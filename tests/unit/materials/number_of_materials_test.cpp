#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "processing/brdf/cluster_materials.h"
#include "processing/brdf/merge_materials.h"
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

// Each seed takes a second; 100 seeds are for the bench material_count.
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

// Brightness that varies from lumitexel to lumitexel by 4 %, as paint does: a spread, and not two materials. Where merging did not allow
// for it, two or three were found for every seed.
TEST(NumberOfMaterials, OneMaterialIsOneWhereItsBrightnessVaries) {
  std::normal_distribution<double> normal;
  for (unsigned seed = 1; seed <= kSeeds; ++seed) {
    std::mt19937 random(seed);
    Observations observations;
    add_lumitexels(observations, one_lobe({0.2, 0.1, 0.05}, {0.6, 0.6, 0.6}, kMirror, 20.0), 100, 6, 0.03, random);
    for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
      const double factor = 1.0 + 0.04 * normal(random);
      for (std::size_t s = observations.first[i]; s < observations.first[i + 1]; ++s) {
        for (float& r : observations.samples[s].reflectance) r *= static_cast<float>(factor);
      }
    }
    EXPECT_EQ(materials_found(observations, ErrorSource::Estimated), 1u) << "seed " << seed;
  }
}

// Over 1,000 lumitexels a part of them ranks the pairs first: a material in two shades, far apart in likelihood, ranks behind pairs that are
// needed apart, and has to be asked all the same.
TEST(NumberOfMaterials, APairThatRanksLastIsAskedBeforeMergingEnds) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  const Brdf shaded = one_lobe({0.2, 0.1, 0.05}, {0.6, 0.6, 0.6}, kMirror, 20.0);
  Observations observations;
  Mixture mixture;
  add_lumitexels(observations, shaded, 1100, 6, 0.03, random);
  for (std::size_t i = 0; i < observations.lumitexels(); ++i) {
    const double factor = 1.0 + 0.06 * normal(random);
    for (std::size_t s = observations.first[i]; s < observations.first[i + 1]; ++s) {
      for (float& r : observations.samples[s].reflectance) r *= static_cast<float>(factor);
    }
  }
  for (const double factor : {0.95, 1.05}) {
    Brdf shade = shaded;
    for (double& kd : shade.diffuse) kd *= factor;
    for (Lobe& lobe : shade.lobes[0]) lobe.log_strength += std::log(factor);
    mixture.materials.push_back({shade, ErrorModel(0.04, 1e-3)});
  }
  // Four more of few lumitexels each, whose merging would cost less in all and more a sample.
  for (const double kd : {0.020, 0.022, 0.0242, 0.0266}) {
    const Brdf rare = one_lobe({kd, kd, kd}, {0.1, 0.1, 0.1}, kMirror, 20.0);
    add_lumitexels(observations, rare, 40, 6, 0.03, random);
    mixture.materials.push_back({rare, ErrorModel(0.03, 1e-3)});
  }
  mixture.share = {0.44, 0.44, 0.03, 0.03, 0.03, 0.03};
  LumitexelList all(observations.lumitexels());
  std::iota(all.begin(), all.end(), std::size_t{0});
  MergeOptions options;
  options.fit.choose_lobes = false;
  maximise_expectation(mixture, observations, all, options.fit, {});
  ASSERT_EQ(mixture.materials.size(), 6u);
  merge_materials(mixture, observations, all, options, [](int) {});
  const auto shades = std::count_if(mixture.materials.begin(), mixture.materials.end(),
                                    [](const MaterialModel& material) { return material.brdf.diffuse[0] > 0.1; });
  EXPECT_EQ(shades, 1);
}

// Two materials given as four, each twice and a little apart: splitting went too far, and merging alone has to see it.
TEST(NumberOfMaterials, MergingUndoesWhatSplittingOverdid) {
  const Brdf first = one_lobe({0.20, 0.05, 0.04}, {0.3, 0.3, 0.3}, kMirror, 8.0), second = one_lobe({0.04, 0.06, 0.20}, {1.5, 1.5, 1.5}, kMirror, 60.0);
  for (const bool estimated : {false, true}) {
    unsigned two = 0;
    for (unsigned seed = 0; seed < kSeeds; ++seed) {
      std::mt19937 random(seed);
      Observations observations;
      add_lumitexels(observations, first, 120, 6, 0.05, random);
      add_lumitexels(observations, second, 80, 6, 0.05, random);
      LumitexelList all(observations.lumitexels());
      std::iota(all.begin(), all.end(), std::size_t{0});
      Mixture mixture;
      for (const Brdf& brdf : {first, second}) {
        for (const double factor : {0.95, 1.05}) {
          Brdf copy = brdf;
          for (double& kd : copy.diffuse) kd *= factor;
          mixture.materials.push_back({copy, ErrorModel(estimated ? 0.05 : 0.3, 0.02)});
          mixture.share.push_back(0.25);
        }
      }
      MergeOptions options;
      options.fit.choose_lobes = false;
      options.fit.estimate_error = estimated;
      options.fit.error = ErrorModel(0.3, 0.02);
      maximise_expectation(mixture, observations, all, options.fit, {});
      ASSERT_EQ(mixture.materials.size(), 4u);  // nothing but merging brings them together
      merge_materials(mixture, observations, all, options, [](int) {});
      two += mixture.materials.size() == 2;
    }
    EXPECT_EQ(two, kSeeds) << (estimated ? "estimated" : "given");
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
