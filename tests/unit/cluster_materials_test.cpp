#include "processing/brdf/cluster_materials.h"

#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "processing/brdf/misfit.h"
#include "processing/brdf/select_lumitexels.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

struct ThreeMaterials {
  std::vector<Brdf> truth{one_lobe({0.20, 0.05, 0.04}, {0.3, 0.3, 0.3}, 0.7853981633974483, 8.0),
                                   one_lobe({0.04, 0.06, 0.20}, {1.5, 1.5, 1.5}, 0.7853981633974483, 60.0),
                                   one_lobe({0.01, 0.01, 0.01}, {3.0, 2.0, 1.0}, 0.7853981633974483, 25.0)};
  Observations observations;
  explicit ThreeMaterials(unsigned seed) {
    std::mt19937 random(seed);
    const int counts[] = {600, 300, 100};  // uneven on purpose
    for (std::size_t j = 0; j < 3; ++j) add_lumitexels(observations, truth[j], counts[j], 6, 0.05, random);
  }
  std::size_t material_of(std::size_t lumitexel) const { return lumitexel < 600 ? 0 : lumitexel < 900 ? 1 : 2; }
};

ClusterOptions options_for(int materials) {
  ClusterOptions options;
  options.materials = materials;
  options.fit.error = {0.05, 1e-3};
  return options;
}

Clustering cluster(const Observations& observations, int materials) {
  return cluster_materials(observations, select_lumitexels(observations, 500), options_for(materials), [](int) {});
}

TEST(ClusterMaterials, FindsUnevenMaterialsAndLabelsTheirTexels) {
  constexpr double kFewestRight = 0.98;  // at 5 % noise and such different materials hardly a texel is ambiguous
  for (const unsigned seed : {1u, 2u, 3u}) {
    const ThreeMaterials scene(seed);
    const Clustering found = cluster(scene.observations, 3);
    ASSERT_EQ(found.materials.size(), 3u);
    std::array<std::array<int, 3>, 3> votes{};
    for (std::size_t i = 0; i < found.label.size(); ++i) {
      ++votes[static_cast<std::size_t>(found.label[i])][scene.material_of(i)];
    }
    double right = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      const auto best = std::max_element(votes[j].begin(), votes[j].end());
      right += *best;
      const Brdf& truth = scene.truth[static_cast<std::size_t>(best - votes[j].begin())];
      // 5 % noise over at least 100 x 6 x 3 samples leaves well under 2 % in N.
      EXPECT_NEAR(found.materials[j].model.brdf.lobes[0][0].log_shape, truth.lobes[0][0].log_shape, 0.06) << seed;
    }
    EXPECT_GE(right / static_cast<double>(found.label.size()), kFewestRight) << seed;
  }
}

TEST(ClusterMaterials, TheSingleBrdfIsOneFitToEverything) {
  const ThreeMaterials scene(4);
  EXPECT_EQ(cluster(scene.observations, 1).materials.size(), 1u);
  ClusterOptions options = options_for(1);
  options.errors = ErrorSource::Given;  // by which the single BRDF is always fitted
  const Clustering found =
      cluster_materials(scene.observations, select_lumitexels(scene.observations, 500), options, [](int) {});
  double single = 0, material = 0;
  for (std::size_t i = 0; i < found.label.size(); ++i) {
    single += misfit(found.single.brdf, scene.observations.of(i), {0.05, 1e-3});
    material += misfit(found.materials[0].model.brdf, scene.observations.of(i), {0.05, 1e-3});
  }
  EXPECT_NEAR(single / material, 1.0, 1e-3);
}

// What all stages are measured against must not depend on how the materials were fitted.
TEST(ClusterMaterials, TheSingleBrdfIsTheSameWhateverTheErrorsOfTheMaterials) {
  const ThreeMaterials scene(6);
  std::vector<Brdf> singles;
  for (const ErrorSource errors : {ErrorSource::Given, ErrorSource::Labels, ErrorSource::Estimated}) {
    ClusterOptions options = options_for(3);
    options.errors = errors;
    singles.push_back(
        cluster_materials(scene.observations, select_lumitexels(scene.observations, 500), options, [](int) {}).single.brdf);
  }
  for (const Brdf& single : singles) {
    EXPECT_EQ(single.diffuse, singles[0].diffuse);
    ASSERT_EQ(single.lobes.size(), singles[0].lobes.size());
  }
}

double share_of_pairs_alike(const std::vector<int>& a, const std::vector<int>& b) {
  double alike = 0, pairs = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = i + 1; j < a.size(); j += 7, ++pairs) alike += (a[i] == a[j]) == (b[i] == b[j]);
  }
  return alike / pairs;
}

// Samples have changed a little, as when light between surfaces was taken out: materials known before are adapted, and stay apart.
TEST(ClusterMaterials, MaterialsKnownBeforeAreAdapted) {
  constexpr double kAlike = 0.99;  // another noise makes hardly a texel ambiguous
  const ThreeMaterials before(7), after(8);
  const Clustering known = cluster(before.observations, 3);
  ClusterOptions options = options_for(3);
  options.before = {&known, false};
  const Clustering adapted = cluster_materials(after.observations, select_lumitexels(after.observations, 500), options, [](int) {});
  ASSERT_EQ(adapted.materials.size(), 3u);
  EXPECT_GE(share_of_pairs_alike(adapted.label, known.label), kAlike);
  EXPECT_NE(adapted.materials[0].model.brdf.diffuse, known.materials[0].model.brdf.diffuse) << "they follow the samples";
  EXPECT_NEAR(adapted.materials[0].model.brdf.diffuse[0], known.materials[0].model.brdf.diffuse[0], 0.05 * known.materials[0].model.brdf.diffuse[0]);
}

// What was known before is a candidate, not the answer: one material for three predicts left-out samples worse than a search from nothing.
TEST(ClusterMaterials, MaterialsKnownBeforeGiveWayToBetterOnes) {
  const ThreeMaterials scene(9);
  const Clustering poor = cluster(scene.observations, 1);
  ClusterOptions options = options_for(3);
  options.before = {&poor, true};
  EXPECT_EQ(cluster_materials(scene.observations, select_lumitexels(scene.observations, 500), options, [](int) {}).materials.size(), 3u);
  options.before.anew = false;
  EXPECT_EQ(cluster_materials(scene.observations, select_lumitexels(scene.observations, 500), options, [](int) {}).materials.size(), 1u);
}

TEST(ClusterMaterials, ProgressGoesOneWayAndIsMadeInSmallSteps) {
  constexpr int kLongest = 16;  // splitting tries as many materials as the scene might have, and stops where nothing is gained
  const ThreeMaterials scene(4);
  for (const int materials : {3, 0}) {
    const ClusterOptions options = options_for(materials);
    std::vector<int> steps;
    cluster_materials(scene.observations, select_lumitexels(scene.observations, 500), options, [&](int done) { steps.push_back(done); });
    EXPECT_EQ(steps.front(), 0);
    EXPECT_EQ(steps.back(), clustering_steps(options));
    for (std::size_t i = 1; i < steps.size(); ++i) {
      EXPECT_GE(steps[i], steps[i - 1]) << materials << " asked for, report " << i;
      EXPECT_LE(steps[i] - steps[i - 1], kLongest) << materials << " asked for, report " << i;
    }
  }
}

TEST(ClusterMaterials, ResultsDoNotDependOnTheNumberOfThreads) {
  const ThreeMaterials scene(5);
  const Clustering many = cluster(scene.observations, 3);
  const oneapi::tbb::global_control one_thread(oneapi::tbb::global_control::max_allowed_parallelism, 1);
  const Clustering one = cluster(scene.observations, 3);
  EXPECT_EQ(many.label, one.label);
  for (std::size_t j = 0; j < 3; ++j) {
    EXPECT_EQ(many.materials[j].model.brdf.diffuse, one.materials[j].model.brdf.diffuse);
    EXPECT_EQ(many.materials[j].model.brdf.lobes[0][0].log_shape, one.materials[j].model.brdf.lobes[0][0].log_shape);
  }
}

TEST(ClusterMaterials, ALumitexelWithoutSamplesGetsTheLargestMaterial) {
  ThreeMaterials scene(6);
  scene.observations.first.push_back(scene.observations.samples.size());
  const Clustering found = cluster(scene.observations, 3);
  std::size_t largest = 0;
  for (std::size_t j = 1; j < found.materials.size(); ++j) {
    if (found.materials[j].members > found.materials[largest].members) largest = j;
  }
  EXPECT_EQ(found.label.back(), static_cast<int>(largest));
}

TEST(SelectLumitexels, PrefersThoseNearAMirrorReflection) {
  const ThreeMaterials scene(8);
  const auto chosen = select_lumitexels(scene.observations, 200);
  EXPECT_LE(chosen.size(), 200u);
  EXPECT_TRUE(std::is_sorted(chosen.begin(), chosen.end()));
  double chosen_mean = 0, mean = 0;
  for (const std::size_t i : chosen) chosen_mean += mirror_nearness(scene.observations.of(i)) / static_cast<double>(chosen.size());
  const std::size_t all = scene.observations.lumitexels();
  for (std::size_t i = 0; i < all; ++i) mean += mirror_nearness(scene.observations.of(i)) / static_cast<double>(all);
  EXPECT_GT(chosen_mean, mean);
}

TEST(SelectLumitexels, OtherDrawsAreOthersAsManyAndNearAsOften) {
  const ThreeMaterials scene(8);
  const auto nearness = [&](const std::vector<std::size_t>& chosen) {
    double sum = 0;
    for (const std::size_t i : chosen) sum += mirror_nearness(scene.observations.of(i));
    return sum / static_cast<double>(chosen.size());
  };
  const auto first = select_lumitexels(scene.observations, 200);
  EXPECT_EQ(select_lumitexels(scene.observations, 200, 0), first);
  for (const int draw : {1, 2, 3}) {
    const auto other = select_lumitexels(scene.observations, 200, draw);
    std::vector<std::size_t> both;
    std::set_intersection(first.begin(), first.end(), other.begin(), other.end(), std::back_inserter(both));
    EXPECT_LT(both.size(), first.size() / 2) << draw;
    EXPECT_NEAR(static_cast<double>(other.size()), static_cast<double>(first.size()), 20.0) << draw;  // points chosen for both reasons count once
    EXPECT_NEAR(nearness(other), nearness(first), 0.02) << draw;
  }
}

}  // namespace
}  // namespace lumitexel
