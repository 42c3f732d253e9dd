#include "processing/fit/indirect_trial.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <random>

#include "processing/brdf/numerics/synthetic_observations.h"
#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

constexpr std::size_t kViews = 16;
constexpr double kReflectance = 0.2;  // 1/sr
constexpr double kLight = 0.1;        // light between surfaces, of the lamp's, on the mean
const ErrorModel kError(0.3, 0.02);

struct World {
  double share = 1.0;        // of the predicted light, that is really there
  double by_view = 0.0;      // by how much that share differs between photographs, one sigma
  double scatter = 0.0;      // of a predicted sample, of kLight
  std::size_t lumitexels = 400;
};

struct Photographed {
  Observations before, without;
  Model model;
  std::vector<int> label;
  std::vector<TexelWeights> weights;

  IndirectWorth worth() const { return try_without_indirect(before, without, model, label, weights, kError); }
};

void fit_factors(Photographed& scene) {
  for (std::size_t i = 0; i < scene.before.lumitexels(); ++i) {
    double both = 0.0, own = 0.0;
    for (const Observation& sample : scene.before.of(i)) {
      const double predicted = kReflectance * sample.geometry.cos_i;
      both += predicted * static_cast<double>(sample.reflectance[0]);
      own += predicted * predicted;
    }
    TexelWeights weights;
    weights.weight = {static_cast<float>(both / own)};
    scene.weights.push_back(weights);
  }
}

// Matte lumitexels with 5 % noise, each photograph up to 10 % too bright or dark. Light between surfaces differs from sample to sample.
Photographed photographed(const World& world, std::uint64_t seed) {
  Photographed scene;
  scene.model.channels = 3;
  const Brdf brdf = diffuse_brdf(kReflectance, kReflectance, kReflectance);
  scene.model.materials.push_back({brdf, {brdf}, {}});
  scene.before = random_observations(brdf, world.lumitexels, kViews, 0.05, seed);
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> normal;
  std::vector<double> level(kViews), share(kViews);
  for (double& of_view : level) of_view = 0.9 + 0.2 * unit(random);
  for (double& of_view : share) of_view = world.share + world.by_view * normal(random);
  scene.without = scene.before;
  for (std::size_t k = 0; k < scene.before.samples.size(); ++k) {
    const std::size_t view = k % kViews;
    scene.before.view.push_back(static_cast<std::uint16_t>(view));
    const double light = 2.0 * kLight * kReflectance * unit(random), off = world.scatter * kLight * kReflectance;
    for (std::size_t c = 0; c < 3; ++c) {
      const double straight = static_cast<double>(scene.before.samples[k].reflectance[c]) * level[view], found = light + off * normal(random);
      scene.before.samples[k].reflectance[c] = static_cast<float>(straight + share[view] * light);
      scene.without.samples[k].reflectance[c] = static_cast<float>(straight + share[view] * light - found);
      scene.without.samples[k].variance[c] = scene.before.samples[k].variance[c] + static_cast<float>(off * off);
    }
  }
  scene.label.assign(world.lumitexels, 0);
  fit_factors(scene);
  return scene;
}

int times_shown(const World& world) {
  int shown = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) shown += photographed(world, seed).worth().enough();
  return shown;
}

TEST(IndirectTrial, SaysYesWhereTheLightIsThereAndNoWhereItIsNot) {
  EXPECT_GE(times_shown({1.0}), 95);
  EXPECT_LE(times_shown({0.0}), 5);
}

// Photographs that contradict each other are no proof, whatever the slope of all together.
TEST(IndirectTrial, SaysNoWherePhotographsDisagree) {
  EXPECT_GT(photographed({0.4}, 1).worth().slope, IndirectWorth::kLeastSlope);
  EXPECT_GE(times_shown({0.4}), 95);
  EXPECT_LE(times_shown({0.4, 1.0}), 25);  // 1.6 sigma on the mean of 16
  EXPECT_LE(times_shown({0.0, 1.0}), 5);
}

// However sure: so little of what was predicted that subtracting it would harm more than help.
TEST(IndirectTrial, SaysNoToASmallShare) {
  const IndirectWorth worth = photographed({0.15}, 1).worth();
  EXPECT_GT(worth.slope, IndirectWorth::kStandardErrors * worth.sigma);
  EXPECT_FALSE(worth.enough());
}

TEST(IndirectTrial, SlopeIsTheShareThatIsThereHoweverPathsScatter) {
  for (const double scatter : {0.0, 1.0, 2.0}) {
    for (const double share : {0.0, 0.5, 1.0}) {
      const IndirectWorth worth = photographed({share, 0.0, scatter, 2000}, 3).worth();
      EXPECT_NEAR(worth.slope, share, 4.0 * worth.sigma) << share << ' ' << scatter;  // one in ten thousand by chance, if sigma is right
      EXPECT_LT(worth.sigma, 0.1) << share << ' ' << scatter;
      EXPECT_EQ(worth.samples, 2000 * kViews);
      EXPECT_EQ(worth.photographs, kViews);
    }
  }
}

// Errors that a photograph's samples share: sigma is by photographs, or far too small.
TEST(IndirectTrial, SigmaIsTheScatterOfRepeatedSessions) {
  double squares = 0.0, claimed = 0.0;
  constexpr int kSessions = 100;
  for (std::uint64_t seed = 1; seed <= kSessions; ++seed) {
    const IndirectWorth worth = photographed({0.5, 0.4}, seed).worth();
    squares += (worth.slope - 0.5) * (worth.slope - 0.5) / kSessions;
    claimed += worth.sigma * worth.sigma / kSessions;
  }
  EXPECT_NEAR(std::sqrt(claimed / squares), 1.0, 0.25);  // 100 sessions know a deviation to 7 %; three of that, and what the jackknife adds
}

// Three tenths more everywhere: a fit takes that for albedo, and nothing proves it wrong.
TEST(IndirectTrial, LightThatGoesWithTheLampsOwnProvesNothing) {
  Photographed scene = photographed({0.0}, 5);
  for (std::size_t k = 0; k < scene.before.samples.size(); ++k) {
    for (std::size_t c = 0; c < 3; ++c) {
      const double predicted = kReflectance * scene.before.samples[k].geometry.cos_i;
      scene.without.samples[k].reflectance[c] = scene.before.samples[k].reflectance[c] - static_cast<float>(0.3 * predicted);
    }
  }
  EXPECT_FALSE(scene.worth().enough());
}

// A grazing lamp or a bad pose: one photograph holds nearly all of the light, and follows it.
TEST(IndirectTrial, OnePhotographDoesNotDecide) {
  Photographed scene = photographed({0.0}, 6);
  for (std::size_t k = 0; k < scene.before.samples.size(); ++k) {
    if (k % kViews != 3) continue;
    for (std::size_t c = 0; c < 3; ++c) {
      const float light = static_cast<float>(kReflectance * (k % 3 == 0 ? 0.0 : 1.0));
      scene.before.samples[k].reflectance[c] += 0.5f * light;
      scene.without.samples[k].reflectance[c] = scene.before.samples[k].reflectance[c] - light;
    }
  }
  scene.weights.clear();
  fit_factors(scene);
  const IndirectWorth worth = scene.worth();
  EXPECT_GT(worth.slope, IndirectWorth::kLeastSlope);
  EXPECT_FALSE(worth.enough());
}

TEST(IndirectTrial, FewPhotographsOrNoLightAreNoAnswer) {
  Photographed scene = photographed({1.0}, 1);
  for (std::uint16_t& view : scene.before.view) view %= 4;
  EXPECT_FALSE(scene.worth().judged());
  std::fill(scene.before.view.begin(), scene.before.view.end(), std::uint16_t{2});
  EXPECT_TRUE(std::isnan(scene.worth().sigma));
  EXPECT_FALSE(scene.worth().enough());
  scene.without = scene.before;
  EXPECT_EQ(scene.worth().slope, 0.0);
  EXPECT_EQ(scene.worth().samples, 0u);
  EXPECT_FALSE(scene.worth().enough());
}

TEST(IndirectTrial, HasTheSameBitsForAnyNumberOfThreads) {
  const Photographed scene = photographed({1.0, 0.1, 1.0, 10'000}, 2);  // blocks of sums hold some 2,000
  std::vector<IndirectWorth> worths;
  for (const std::size_t threads : {1, 2, 4}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    worths.push_back(scene.worth());
  }
  for (const IndirectWorth& other : worths) {
    EXPECT_EQ(other.slope, worths[0].slope);
    EXPECT_EQ(other.sigma, worths[0].sigma);
  }
}

}  // namespace
}  // namespace lumitexel
