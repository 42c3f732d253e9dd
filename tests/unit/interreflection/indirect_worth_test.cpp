#include "processing/fit/indirect_worth.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

#include "processing/brdf/numerics/synthetic_observations.h"
#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

constexpr std::size_t kLumitexels = 400, kViews = 16;
constexpr double kReflectance = 0.2;  // 1/sr
const ErrorModel kError(0.3, 0.02);

struct Photographed {
  Observations before, without;
  Model model;
  std::vector<int> label;
  std::vector<TexelWeights> weights;

  IndirectWorth worth() const { return indirect_worth(before, without, model, label, weights, kError); }
};

// Matte lumitexels, 5 % noise and each photograph up to 10 % too bright or dark, with `share` of the predicted light really there; light goes with the
// photograph and the place, and is a tenth of the lamp's. Fitted with one factor a lumitexel.
Photographed photographed(double share, std::uint64_t seed) {
  Photographed result;
  result.model.channels = 3;
  const Brdf brdf = diffuse_brdf(kReflectance, kReflectance, kReflectance);
  result.model.materials.push_back({brdf, {brdf}, {}});
  result.without = random_observations(brdf, kLumitexels, kViews, 0.05, seed);
  for (std::size_t k = 0; k < result.without.samples.size(); ++k) result.without.view.push_back(static_cast<std::uint16_t>(k % kViews));
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<double> level(kViews);
  for (double& of_view : level) of_view = 0.9 + 0.2 * unit(random);
  result.before = result.without;
  for (std::size_t k = 0; k < result.before.samples.size(); ++k) {
    Observation &sample = result.before.samples[k], &rest = result.without.samples[k];
    const double light = 0.2 * kReflectance * unit(random);
    for (std::size_t c = 0; c < 3; ++c) {
      const double straight = static_cast<double>(sample.reflectance[c]) * level[k % kViews];
      sample.reflectance[c] = static_cast<float>(straight + share * light);
      rest.reflectance[c] = static_cast<float>(straight + (share - 1.0) * light);
    }
  }
  result.label.assign(kLumitexels, 0);
  for (std::size_t i = 0; i < kLumitexels; ++i) {
    double both = 0.0, own = 0.0;
    for (const Observation& sample : result.before.of(i)) {
      const double predicted = kReflectance * sample.geometry.cos_i;
      both += predicted * static_cast<double>(sample.reflectance[0]);
      own += predicted * predicted;
    }
    TexelWeights weights;
    weights.weight = {static_cast<float>(both / own)};
    result.weights.push_back(weights);
  }
  return result;
}

int times_taken_out(double share) {
  int taken = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) taken += photographed(share, seed).worth().enough();
  return taken;
}

TEST(IndirectWorth, SaysYesWhereTheLightIsThereAndNoWhereItIsNot) {
  EXPECT_GE(times_taken_out(1.0), 95);
  EXPECT_LE(times_taken_out(0.0), 5);
}

TEST(IndirectWorth, SlopeIsTheShareThatIsThere) {
  for (const double share : {0.0, 0.5, 1.0}) {
    const IndirectWorth worth = photographed(share, 3).worth();
    EXPECT_NEAR(worth.slope, share, 4.0 * worth.sigma) << share;  // one in ten thousand by chance, if sigma is right
    EXPECT_LT(worth.sigma, 0.1) << share;
    EXPECT_EQ(worth.samples, kLumitexels * kViews);
  }
}

// Three tenths more everywhere: a fit takes that for albedo, and nothing proves it wrong.
TEST(IndirectWorth, LightThatGoesWithTheLampsOwnProvesNothing) {
  Photographed scene = photographed(0.0, 5);
  for (std::size_t k = 0; k < scene.before.samples.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double predicted = kReflectance * scene.before.samples[k].geometry.cos_i;
      scene.without.samples[k].reflectance[c] = scene.before.samples[k].reflectance[c] - static_cast<float>(0.3 * predicted);
    }
  }
  EXPECT_FALSE(scene.worth().enough());
}

TEST(IndirectWorth, OnePhotographOrNoLightIsNoAnswer) {
  Photographed scene = photographed(1.0, 1);
  std::fill(scene.before.view.begin(), scene.before.view.end(), std::uint16_t{2});
  EXPECT_TRUE(std::isnan(scene.worth().sigma));
  EXPECT_FALSE(scene.worth().enough());
  scene.without = scene.before;
  EXPECT_EQ(scene.worth().slope, 0.0);
  EXPECT_EQ(scene.worth().samples, 0u);
  EXPECT_FALSE(scene.worth().enough());
}

TEST(IndirectWorth, HasTheSameBitsForAnyNumberOfThreads) {
  const Photographed scene = photographed(1.0, 2);
  std::vector<double> slopes;
  for (const std::size_t threads : {1, 2, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    slopes.push_back(scene.worth().slope);
  }
  EXPECT_EQ(slopes[1], slopes[0]);
  EXPECT_EQ(slopes[2], slopes[0]);
}

}  // namespace
}  // namespace lumitexel
