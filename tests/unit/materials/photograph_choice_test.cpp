// How many materials there are where what errs together is a photograph, as it does under wrong normals or a wrong lamp: on one part of the surface
// a photograph is too bright, on the other too dark.
#include <gtest/gtest.h>
#include <oneapi/tbb/parallel_for.h>

#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "processing/brdf/choose_materials.h"
#include "processing/brdf/cluster_materials.h"
#include "processing/brdf/left_out_folds.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr int kPhotographs = 12, kSeeds = 20;
constexpr std::size_t kLumitexels = 240;
constexpr double kNoise = 0.03, kOfPhotograph = 0.25;  // relative, one sigma

const Brdf kRed = one_lobe({0.20, 0.05, 0.04}, {0.3, 0.3, 0.3}, kMirrorAim, 20.0);
const Brdf kBlue = one_lobe({0.04, 0.06, 0.20}, {0.3, 0.3, 0.3}, kMirrorAim, 20.0);
const Brdf kBlack = one_lobe({0.02, 0.02, 0.02}, {1.2, 1.2, 1.2}, kMirrorAim, 40.0);

Eigen::Vector3d direction(double theta, double azimuth) {
  return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}

// Materials take turns, so that one that stands in the list more often has more of the surface. Every other lumitexel of each lies on the other part
// of the surface. Each is seen by half of the photographs.
Observations photographed(const std::vector<Brdf>& materials, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> theta(0.0, 1.1), azimuth(0.0, 2.0 * std::numbers::pi), spread(-0.3, 0.3);
  std::array<Eigen::Vector3d, kPhotographs> light, eye;
  std::array<std::array<double, 2>, kPhotographs> factor{};
  for (std::size_t p = 0; p < kPhotographs; ++p) {
    const double high = theta(random), around = azimuth(random);
    light[p] = direction(high, around);
    eye[p] = p % 2 == 0 ? direction(std::abs(high + spread(random)), around + std::numbers::pi + spread(random)) : direction(theta(random), azimuth(random));
    for (double& part : factor[p]) part = std::exp(kOfPhotograph * normal(random));
  }
  Observations observations;
  observations.channels = 3;
  for (std::size_t l = 0; l < kLumitexels; ++l) {
    const Eigen::Vector3d up = Eigen::Vector3d(0.15 * normal(random), 0.15 * normal(random), 1.0).normalized();
    const std::size_t part = l % 2;
    for (std::size_t p = 0; p < kPhotographs; ++p) {
      if ((p + l / 2) % 2 != 0) continue;
      Observation sample;
      sample.geometry = lobe_geometry(up, light[p], eye[p]);
      if (sample.geometry.cos_i <= 0.05 || sample.geometry.cos_o <= 0.05) continue;
      const ChannelValues r = predicted_reflectance(materials[(l / 4) % materials.size()], sample.geometry);
      for (std::size_t c = 0; c < 3; ++c) sample.reflectance[c] = static_cast<float>(r[c] * factor[p][part] * (1.0 + kNoise * normal(random)));
      observations.samples.push_back(sample);
      observations.view.push_back(static_cast<std::uint16_t>(p));
    }
    observations.first.push_back(observations.samples.size());
  }
  return observations;
}

std::size_t materials_found(const Observations& observations) {
  ClusterOptions options;
  options.materials = 0;
  options.fit.error = ErrorModel(0.3, 0.02);
  return cluster_materials(observations, with_samples(observations), options, [](int) {}).materials.size();
}

// Of so many seeds, those with so many materials found; `known`: whether samples know their photographs.
int seeds_with(std::size_t wanted, const std::vector<Brdf>& materials, bool known, int seeds = kSeeds) {
  std::atomic<int> count = 0;
  oneapi::tbb::parallel_for(1, seeds + 1, [&](int seed) {
    Observations observations = photographed(materials, static_cast<unsigned>(seed));
    if (!known) observations.view.clear();
    if (materials_found(observations) == wanted) ++count;
  });
  return count;
}

TEST(PhotographChoice, WhatErrsTogetherInAPhotographIsNoMaterial) {
  EXPECT_GE(seeds_with(1, {kRed}, true), kSeeds - 1);
  EXPECT_LT(seeds_with(1, {kRed}, false), kSeeds - 4) << "else there is nothing to show: left-out samples see no harm in more";
}

TEST(PhotographChoice, WhatLooksDifferentInEveryPhotographIs) { EXPECT_GE(seeds_with(2, {kRed, kBlue}, true), kSeeds - 1); }

TEST(PhotographChoice, ThreeAreThree) { EXPECT_GE(seeds_with(3, {kRed, kBlue, kBlack}, true), kSeeds - 1); }

// The campaign behind the two: target run_materials_campaign. What it last gave is in the README.
TEST(PhotographChoice, DISABLED_HundredSeeds) {
  const int one = seeds_with(1, {kRed}, true, 100), unknown = seeds_with(1, {kRed}, false, 100), two = seeds_with(2, {kRed, kBlue}, true, 100);
  std::printf("one is one in %d of 100 (in %d where samples do not know their photographs), two are two in %d\n", one, unknown, two);
  EXPECT_GE(one, 95);
  EXPECT_GE(two, 95);
}

TEST(PhotographFolds, ShowEachSampleOnOneSideAndEveryPhotographOnce) {
  const Observations observations = photographed({kRed}, 1);
  const LumitexelList some{3, 5, 8, 200};
  EXPECT_EQ(photographs_of(observations, some), std::size_t{kPhotographs});
  std::vector<int> left_out(kPhotographs, 0);
  std::size_t samples = 0;
  for (const std::size_t l : some) samples += observations.of(l).size();
  for (std::size_t f = 0; f < 4; ++f) {
    const PhotographFold fold = photograph_fold(observations, some, f, 4);
    ASSERT_EQ(fold.shown.lumitexels(), some.size());
    ASSERT_EQ(fold.left_out.lumitexels(), some.size());
    EXPECT_EQ(fold.shown.samples.size() + fold.left_out.samples.size(), samples);
    for (const std::uint16_t v : fold.left_out.view) {
      left_out[v] |= 1 << f;
      EXPECT_EQ(std::count(fold.shown.view.begin(), fold.shown.view.end(), v), 0);
    }
    EXPECT_EQ(fold.shown.of(2).size() + fold.left_out.of(2).size(), observations.of(8).size());
  }
  for (const int folds : left_out) EXPECT_TRUE(folds == 1 || folds == 2 || folds == 4 || folds == 8) << "in one fold alone";
}

TEST(PhotographFolds, WithoutPhotographsThereAreNone) {
  Observations observations = photographed({kRed}, 1);
  observations.view.clear();
  EXPECT_EQ(photographs_of(observations, {0, 1}), 0u);
}

}  // namespace
}  // namespace lumitexel
