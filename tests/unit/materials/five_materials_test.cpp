#include "processing/brdf/experiment/five_materials.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "processing/brdf/experiment/label_bound.h"
#include "processing/brdf/experiment/parameter_bound.h"

namespace lumitexel {
namespace {

FiveMaterialsScore score_of_fit(const FiveMaterials& world, ErrorSource errors) {
  LumitexelList all(world.label.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  ClusterOptions cluster;
  cluster.materials = 5;
  cluster.errors = errors;
  cluster.final_lumitexels = all.size();
  return score(world, cluster_materials(world.observations, all, cluster, [](int) {}));
}

// The true BRDFs themselves score as the bound's expectation does not: no error, and Bayes' accuracy.
TEST(FiveMaterials, TheTruthScoresWithoutError) {
  FiveMaterialsOptions options;
  options.gaussian = true;
  options.lumitexels = 500;
  const FiveMaterials world = make_five_materials(1, options);
  Clustering truth;
  for (const Brdf& brdf : world.truth) truth.materials.push_back({{brdf, ErrorModel(world.relative_sigma, 1e-6)}, {}, 0});
  truth.label = world.label;
  const FiveMaterialsScore result = score(world, truth);
  EXPECT_TRUE(result.all_found);
  EXPECT_NEAR(result.worst_exponent, 0.0, 1e-12);
  EXPECT_EQ(result.accuracy, 1.0);
  EXPECT_GT(result.bayes_accuracy, 0.6);
  EXPECT_LT(result.bayes_accuracy, 1.0);
}

Clustering moved_truth(const FiveMaterials& world, const std::vector<MaterialBound>& by) {
  Clustering clustering;
  for (std::size_t k = 0; k < by.size(); ++k) {
    Brdf brdf = world.truth[k];
    for (auto& channel : brdf.lobes[0]) channel.log_shape += by[k].log_exponent;
    for (std::size_t c = 0; c < 3; ++c) brdf.diffuse[c] -= by[k].diffuse[c];
    clustering.materials.push_back({{brdf, ErrorModel(world.relative_sigma, 1e-6)}, {}, 0});
  }
  clustering.label = world.label;
  return clustering;
}

TEST(FiveMaterials, ErrorsAreCountedInBoundsOfBothKinds) {
  FiveMaterialsOptions options;
  options.gaussian = true;
  FiveMaterials world = make_five_materials(1, options);
  const FiveMaterialsScore labelled = score(world, moved_truth(world, bound_with_labels(world)));
  EXPECT_NEAR(labelled.squared_exponent, 1.0, 1e-9);
  EXPECT_NEAR(labelled.squared_diffuse, 1.0, 1e-9);
  EXPECT_LT(labelled.squared_diffuse_unlabelled, 0.9);
  const FiveMaterialsScore unlabelled = score(world, moved_truth(world, bound_without_labels(world)));
  EXPECT_NEAR(unlabelled.squared_exponent_unlabelled, 1.0, 1e-9);
  EXPECT_NEAR(unlabelled.squared_diffuse_unlabelled, 1.0, 1e-9);
  world.options.gaussian = false;  // of uniform noise that bound is not known
  EXPECT_TRUE(std::isnan(score(world, moved_truth(world, bound_with_labels(world))).squared_exponent_unlabelled));
}

// Uniform noise rules materials out. 2,000 labels are known to 0.008, the difference of two such much better.
TEST(FiveMaterials, TheTrueLawOfTheNoiseLabelsBetterThanANormalOne) {
  for (const double outliers : {0.0, 0.02}) {
    FiveMaterialsOptions options;
    options.outliers = outliers;
    options.lumitexels = 2000;
    const FiveMaterials world = make_five_materials(3, options);
    EXPECT_GT(bayes_accuracy(world), accuracy_by_normal_noise(world) + 0.003) << outliers;
    EXPECT_LT(bayes_accuracy(world), 0.95) << outliers;
  }
}

TEST(FiveMaterials, OutliersAreAsWellBorneAsTheirAbsence) {
  FiveMaterialsOptions options;
  options.outliers = 0.02;
  const FiveMaterialsScore result = score_of_fit(make_five_materials(1, options), ErrorSource::Auto);
  ASSERT_TRUE(result.all_found);
  // Mean squares of five and fifteen errors over the bound's: below 3 and 2.1 for 99 of 100 seeds at the bound. Student's tails gave 7.3, best
  // mean predictions, which outliers pull up by a percent, 700.
  EXPECT_LT(result.squared_exponent, 3.0);
  EXPECT_LT(result.squared_diffuse, 2.2);
  EXPECT_GT(result.accuracy, result.bayes_accuracy - 0.008);  // the goal is 0.5 % in the mean over seeds
}

TEST(FiveMaterials, ASmallExperimentFindsAllFive) {
  FiveMaterialsOptions options;
  options.lumitexels = 1200;
  const FiveMaterialsScore result = score_of_fit(make_five_materials(2, options), ErrorSource::Estimated);
  EXPECT_TRUE(result.all_found);
  EXPECT_LT(result.worst_exponent, 0.01);  // the bound is some 0.2 % for each of the five
}

}  // namespace
}  // namespace lumitexel
