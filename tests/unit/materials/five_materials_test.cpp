#include "processing/brdf/experiment/five_materials.h"

#include <gtest/gtest.h>

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

struct Ratio {
  double exponent = 0, diffuse = 0;
};

// Of what can be known without labels to what can be with them: means over the materials.
Ratio without_labels_over_with(const FiveMaterials& world) {
  const std::vector<MaterialBound> wider = bound_without_labels(world), narrower = bound_with_labels(world);
  Ratio mean;
  for (std::size_t k = 0; k < wider.size(); ++k) {
    mean.exponent += wider[k].log_exponent / narrower[k].log_exponent / 5.0;
    mean.diffuse += wider[k].diffuse[0] / narrower[k].diffuse[0] / 5.0;
  }
  return mean;
}

// kd suffers more from not knowing which is which than N does: who saw no highlight knows nothing of N, labelled or not.
TEST(FiveMaterials, WithoutLabelsLessIsToBeKnownUntilNoiseIsSmall) {
  FiveMaterialsOptions options;
  options.gaussian = true;
  constexpr double kDrawsKnowIt = 0.02;  // the bound is worked out from draws of the noise; seeds differ by as much
  const Ratio noisy = without_labels_over_with(make_five_materials(1, options));
  EXPECT_GT(noisy.diffuse, 1.05);
  EXPECT_GT(noisy.exponent, 1.0);
  options.noise = 1e-3;  // nineteen lumitexels of twenty tell whose they are
  const Ratio quiet = without_labels_over_with(make_five_materials(1, options));
  EXPECT_NEAR(quiet.diffuse, 1.0, 0.5 * (noisy.diffuse - 1.0));
  EXPECT_NEAR(quiet.exponent, 1.0, kDrawsKnowIt);
}

TEST(FiveMaterials, TheChanceAtTheBoundIsThatOfIndependentErrors) {
  const std::vector<Brdf> truth = five_materials_truth();
  std::vector<MaterialBound> bound(5, {1e-9, {1e-9, 1e-9, 1e-9}});
  EXPECT_NEAR(chance_within(0.002, bound, truth), 1.0, 1e-12);
  bound[1].log_exponent = 0.002;
  bound[4].diffuse[2] = 0.001 * truth[4].diffuse[2];
  EXPECT_NEAR(chance_within(0.002, bound, truth), 0.682689 * 0.954500, 1e-6);  // within one sigma, and within two
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
