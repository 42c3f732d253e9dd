#include "processing/brdf/choose_materials.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "processing/brdf/error_choice.h"
#include "processing/brdf/projected_error.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr double kMirror = 0.7853981633974483, kNoise = 0.03;
constexpr int kSamples = 12;
const ErrorModel kError(kNoise, 1e-3);

Brdf scaled(Brdf brdf, double factor) {
  for (double& kd : brdf.diffuse) kd *= factor;
  for (auto& channels : brdf.lobes) {
    for (Lobe& lobe : channels) lobe.log_strength += std::log(factor);
  }
  return brdf;
}

Mixture mixture_of(const std::vector<Brdf>& brdfs, const std::vector<double>& share) {
  Mixture mixture;
  for (const Brdf& brdf : brdfs) mixture.materials.push_back({brdf, kError});
  mixture.share = share;
  return mixture;
}

LumitexelList all_of(const Observations& observations) {
  LumitexelList all(observations.lumitexels());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

ChosenMaterials choose(const std::vector<Mixture>& candidates, const Observations& observations, Presumed presumed = Presumed::Few) {
  return choose_materials(candidates, presumed, observations, all_of(observations), all_of(observations), {}, [](int) {});
}

const Brdf kRed = one_lobe({0.20, 0.05, 0.04}, {0.3, 0.3, 0.3}, kMirror, 20.0);
const Brdf kBlue = one_lobe({0.04, 0.06, 0.20}, {0.3, 0.3, 0.3}, kMirror, 20.0);

// Lumitexels of kRed from darker to brighter by `spread`. noise_of_roots: what left-out samples differ from the truth by.
Observations shaded(unsigned seed, double spread = 0.2, int samples = kSamples, double* noise_of_roots = nullptr) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> factor(1.0 - spread, 1.0 + spread);
  Observations observations;
  for (int i = 0; i < 400; ++i) {
    const Brdf brdf = scaled(kRed, factor(random));
    add_lumitexels(observations, brdf, 1, samples, kNoise, random);
    for (const Observation& sample : observations.of(observations.lumitexels() - 1)) {
      if (noise_of_roots != nullptr) *noise_of_roots += squared_error(predicted_reflectance(brdf, sample.geometry), sample, 3, 1e9).root;
    }
  }
  return observations;
}

std::vector<Mixture> shades() {
  return {mixture_of({scaled(kRed, 0.85), kRed, scaled(kRed, 1.15)}, {0.3, 0.4, 0.3}), mixture_of({scaled(kRed, 0.9), scaled(kRed, 1.1)}, {0.5, 0.5}),
          mixture_of({kRed}, {1.0})};
}

// Where each lumitexel had to be one of the materials as they are, three shades would predict better, and surely.
TEST(ChooseMaterials, ShadesThatTexelsMixForThemselvesAreNotMissed) {
  const Observations observations = shaded(1);
  const std::vector<Mixture> candidates = shades();
  const LumitexelList all = all_of(observations);
  const double clip = clip_level(observations, all);
  const auto unmixed = [&](const Mixture& mixture) { return left_out_errors(mixture, observations, all, clip); };
  const std::vector<SquaredError> one = unmixed(candidates[2]), three = unmixed(candidates[0]);
  std::vector<Choice> choices;
  ASSERT_EQ(best_predictor("shades", {{"1", &one}, {"3", &three}}, Claim::Richer, choices), 1u);
  for (unsigned seed = 1; seed <= 4; ++seed) EXPECT_EQ(choose(candidates, shaded(seed)).candidate, 2u) << seed;
}

TEST(ChooseMaterials, AColourThatNoMixtureHasIsMissed) {
  std::mt19937 random(1);
  Observations observations;
  add_lumitexels(observations, kRed, 300, kSamples, kNoise, random);
  add_lumitexels(observations, kBlue, 100, kSamples, kNoise, random);
  const std::vector<Mixture> candidates{mixture_of({scaled(kRed, 0.98), scaled(kRed, 1.02), kBlue}, {0.375, 0.375, 0.25}), mixture_of({kRed, kBlue}, {0.75, 0.25}),
                                        mixture_of({kRed}, {1.0})};
  const ChosenMaterials chosen = choose(candidates, observations);
  EXPECT_EQ(chosen.candidate, 1u);
  ASSERT_EQ(chosen.choices.size(), 2u);
  EXPECT_EQ(chosen.choices[0].candidate + " over " + chosen.choices[0].before, "2 over 1");
  EXPECT_TRUE(chosen.choices[0].taken);
  EXPECT_EQ(chosen.choices[1].candidate + " over " + chosen.choices[1].before, "3 over 2");
  EXPECT_FALSE(chosen.choices[1].taken);
}

TEST(ChooseMaterials, AMaterialOfAHundredthOfTheSurfaceIsMissed) {
  std::mt19937 random(1);
  Observations observations;
  add_lumitexels(observations, kRed, 990, kSamples, kNoise, random);
  add_lumitexels(observations, kBlue, 10, kSamples, kNoise, random);
  EXPECT_EQ(choose({mixture_of({kRed, kBlue}, {0.99, 0.01}), mixture_of({kRed}, {1.0})}, observations).candidate, 0u);
}

// Evidence has asked for three shades, and texels neither miss them nor are worse off with them.
TEST(ChooseMaterials, WhatEvidenceAskedForIsKeptWhereNothingSpeaksAgainstIt) {
  for (unsigned seed = 1; seed <= 4; ++seed) EXPECT_EQ(choose(shades(), shaded(seed), Presumed::Many).candidate, 0u) << seed;
}

// Where samples err together, materials may be found that none is made of: here with highlights too broad, so that texels mix what is not there.
TEST(ChooseMaterials, FewerThanEvidenceAskedForAreTakenWhereTheyPredictBetter) {
  const Brdf broad = one_lobe({0.20, 0.05, 0.04}, {0.1, 0.1, 0.1}, kMirror, 5.0);
  std::mt19937 random(1);
  Observations observations;
  add_lumitexels(observations, kRed, 300, kSamples, kNoise, random);
  const ChosenMaterials chosen =
      choose({mixture_of({scaled(broad, 0.9), scaled(broad, 1.1)}, {0.5, 0.5}), mixture_of({kRed}, {1.0})}, observations, Presumed::Many);
  EXPECT_EQ(chosen.candidate, 1u);
  ASSERT_EQ(chosen.choices.size(), 1u);
  EXPECT_EQ(chosen.choices[0].candidate + " over " + chosen.choices[0].before, "1 over 2");
  EXPECT_TRUE(chosen.choices[0].taken);
}

TEST(ChooseMaterials, OneCandidateIsNoChoice) {
  const ChosenMaterials chosen = choose({mixture_of({kRed}, {1.0})}, shaded(1));
  EXPECT_EQ(chosen.candidate, 0u);
  EXPECT_TRUE(chosen.choices.empty());
}

// Not even where it is presumed.
TEST(ChooseMaterials, WhatIsNoNumberIsNeverKept) {
  Brdf broken = kRed;
  broken.diffuse[0] = std::numeric_limits<double>::quiet_NaN();
  for (const Presumed presumed : {Presumed::Few, Presumed::Many}) {
    EXPECT_EQ(choose({mixture_of({broken, broken}, {0.5, 0.5}), mixture_of({kRed}, {1.0})}, shaded(1), presumed).candidate, 1u);
  }
}

TEST(SquaredErrorOfASample, IsNoNumberWhereThePredictionIsNone) {
  Observation sample;
  sample.reflectance = {0.5f, 0.5f, 0.5f};
  const SquaredError error = squared_error({0.5, std::numeric_limits<double>::quiet_NaN(), 0.5}, sample, 3, 1.0);
  EXPECT_TRUE(std::isnan(error.clipped));
  EXPECT_TRUE(std::isnan(error.root));
}

double error_of_roots(const Observations& observations) {
  const LumitexelList all = all_of(observations);
  return total_error(projected_errors(mixture_of({kRed}, {1.0}), observations, all, all, 1e9)).root;
}

TEST(ProjectedErrors, AreTheNoiseWhereTexelsAreAllAlike) {
  double noise = 0.0;
  const Observations observations = shaded(1, 0.0, kSamples, &noise);
  EXPECT_GT(error_of_roots(observations), 0.99 * noise);
  EXPECT_LT(error_of_roots(observations), 1.05 * noise);  // three free weights of the 27 values shown would cost a ninth
}

// Three samples tell a texel's shade, roughly. Were the fourth among them, its error would be less than its noise.
TEST(ProjectedErrors, NoSamplePredictsItself) {
  double noise = 0.0;
  const Observations observations = shaded(1, 0.5, 4, &noise);
  EXPECT_GT(error_of_roots(observations), 1.1 * noise);
  EXPECT_LT(error_of_roots(observations), 2.0 * noise);
}

TEST(ProjectedErrors, ALumitexelOfOneSampleCountsAsZero) {
  std::mt19937 random(1);
  Observations observations;
  add_lumitexels(observations, kRed, 1, 1, kNoise, random);
  add_lumitexels(observations, kRed, 1, 2, kNoise, random);
  const auto errors = projected_errors(mixture_of({kRed}, {1.0}), observations, {0, 1}, {0, 1}, 1.0);
  EXPECT_EQ(errors[0].root, 0.0);
  EXPECT_GT(errors[1].root, 0.0);
}

TEST(ProjectedErrors, HaveTheSameBitsForAnyNumberOfThreads) {
  const Observations observations = shaded(2);
  const LumitexelList all = all_of(observations);
  std::vector<std::vector<SquaredError>> errors;
  for (const std::size_t threads : {1, 2, 4}) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    errors.push_back(projected_errors(shades()[0], observations, all, all, 1.0));
    for (std::size_t i = 0; i < all.size(); ++i) {
      EXPECT_EQ(errors.back()[i].root, errors.front()[i].root) << threads << " threads, lumitexel " << i;
      EXPECT_EQ(errors.back()[i].clipped, errors.front()[i].clipped) << threads << " threads, lumitexel " << i;
    }
  }
}

}  // namespace
}  // namespace lumitexel
