#include "processing/brdf/paper_clustering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr double kMirror = 0.7853981633974483;

TEST(PaperClustering, PartsTwoColoursAndLabelsThem) {
  std::mt19937 random(2);
  Observations observations;
  const Brdf red = one_lobe({0.25, 0.05, 0.05}, {0.4, 0.4, 0.4}, kMirror, 15.0);
  const Brdf blue = one_lobe({0.04, 0.06, 0.25}, {0.9, 0.9, 0.9}, kMirror, 40.0);
  add_lumitexels(observations, red, 200, 6, 0.02, random);
  add_lumitexels(observations, blue, 200, 6, 0.02, random);
  LumitexelList all(400);
  std::iota(all.begin(), all.end(), std::size_t{0});
  const Clustering found = paper_clustering(observations, all, {2, 1, 0.3, 400}, [](int) {});
  ASSERT_EQ(found.materials.size(), 2u);
  int right = 0;
  for (std::size_t l = 0; l < 400; ++l) right += (found.label[l] == found.label[0]) == (l < 200);
  EXPECT_GE(right, 396);
  // Each channel has a shape of its own; 2 % noise over 1200 samples leaves well under 5 % in N.
  const auto& lobe = found.materials[static_cast<std::size_t>(found.label[0])].model.brdf.lobes.at(0);
  EXPECT_NEAR(std::exp(lobe[1].log_shape), 15.0, 0.75);
  EXPECT_NE(lobe[0].log_shape, lobe[1].log_shape);
}

// Eq. 6: with s = 1 intensity and colour count alike, with a small s a change of brightness costs less than one of colour.
TEST(PaperClustering, IntensityCountsLessThanColour) {
  Observation sample;
  sample.reflectance = {0.2f, 0.2f, 0.2f};
  const auto cost = [&](double s, const ChannelValues& predicted) {
    return sample_misfit(ErrorModel::paper(3, s), sample, 3, predicted).squares;
  };
  const ChannelValues brighter{0.3, 0.3, 0.3}, redder{0.3, 0.15, 0.15};
  EXPECT_NEAR(cost(1.0, brighter), 0.03, 1e-7);
  EXPECT_NEAR(cost(0.25, brighter), 0.25 * 0.03, 1e-7);
  EXPECT_NEAR(cost(0.25, redder), 0.015, 1e-7);
}

}  // namespace
}  // namespace lumitexel
