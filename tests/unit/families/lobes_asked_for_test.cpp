// Another family's lobes, or a lobe shape for each channel, only where the samples ask for them (the true family: family_choice_test.cpp).
#include <gtest/gtest.h>
#include <oneapi/tbb/parallel_for.h>

#include <atomic>
#include <cmath>

#include "processing/brdf/cluster_materials.h"
#include "tests/unit/families/known_brdfs.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr int kSeeds = 100, kWanted = 95;

Brdf with_exponents(double red, double green, double blue) {
  Brdf brdf = known_brdf(BrdfFamily::Lafortune, {{0.5, 1.0, kMirrorAim}});
  const std::array<double, 3> exponents{red, green, blue};
  for (std::size_t c = 0; c < 3; ++c) brdf.lobes[0][c].log_shape = std::log(exponents[c]);
  return brdf;
}

// What a fit left to choose both chose, of one material with 5 % noise: learnt from 200 lumitexels, judged by as many others.
MaterialFitOptions chosen(const Brdf& truth, int seed) {
  std::mt19937 random(static_cast<unsigned>(seed));
  Observations observations;
  add_lumitexels(observations, truth, 400, 6, 0.05, random);
  ClusterOptions options;
  options.materials = 1;
  options.errors = ErrorSource::Estimated;  // as noise that is noise allows; the others only take longer
  options.fit.error = {0.05, 1e-3};
  options.any_family = true;
  options.lobe_shapes = LobeShapes::Auto;
  LumitexelList learnt;
  for (std::size_t i = 0; i < observations.lumitexels(); i += 2) learnt.push_back(i);
  return cluster_materials(observations, learnt, options, [](int) {}).fit;
}

template <typename Right>
int seeds_of(const Brdf& truth, Right right) {
  std::atomic<int> count = 0;
  oneapi::tbb::parallel_for(1, kSeeds + 1, [&](int seed) {
    if (right(chosen(truth, seed))) ++count;
  });
  testing::Test::RecordProperty("seeds_of_100", count);
  return count;
}

bool is_plain(const MaterialFitOptions& fit) { return fit.family == BrdfFamily::Lafortune && fit.shared_shape; }

TEST(LobesAskedFor, LafortunesOfOneShapeStayAsTheyAre) {
  EXPECT_GE(seeds_of(with_exponents(20.0, 20.0, 20.0), is_plain), kWanted);
}

TEST(LobesAskedFor, AMatteMaterialAsksForNothing) {
  Brdf matte = with_exponents(20.0, 20.0, 20.0);
  matte.lobes.clear();
  EXPECT_GE(seeds_of(matte, is_plain), kWanted);
}

TEST(LobesAskedFor, ShapesThatDifferAreTakenApart) {
  EXPECT_GE(seeds_of(with_exponents(10.0, 20.0, 40.0), [](const MaterialFitOptions& fit) { return !fit.shared_shape; }), kWanted);
}

// Materials known before have their lobes already. What is found anew on the same samples is given its own before the two are compared: neither
// predicts better. With one lobe it would err 180 times as much.
TEST(LobesAskedFor, MaterialsFoundAnewAreGivenTheirsBeforeTheyAreCompared) {
  const Brdf truth = known_brdf(BrdfFamily::Lafortune, {KnownLobe{0.3, 3.0}, KnownLobe{2.0, 100.0}});
  std::mt19937 random(1);
  Observations observations;
  add_lumitexels(observations, truth, 2000, 6, 0.05, random);
  ClusterOptions options;
  options.materials = 1;
  options.errors = ErrorSource::Estimated;
  options.fit.error = {0.05, 1e-3};
  options.fit.most_lobes = 2;
  LumitexelList learnt;
  for (std::size_t i = 0; i < observations.lumitexels(); i += 2) learnt.push_back(i);
  const Clustering before = cluster_materials(observations, learnt, options, [](int) {});
  ASSERT_EQ(before.materials[0].model.brdf.lobes.size(), 2u);
  options.before = {&before, true};
  const Clustering after = cluster_materials(observations, learnt, options, [](int) {});
  ASSERT_EQ(after.choices.size(), 1u);
  EXPECT_EQ(after.choices[0].of, "materials");
  EXPECT_NEAR(after.choices[0].gain.share, 0.0, 0.01);
}

}  // namespace
}  // namespace lumitexel
