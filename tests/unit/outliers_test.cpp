#include "processing/fit/outliers.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

constexpr double kAlbedo = 0.3;  // kd, 1/sr
const LobeGeometry kMirror = geometry_of_cosines(0.5, 0.8660254037844387, 0.8660254037844387);
const LobeGeometry kAside = geometry_of_cosines(0.9, 0.3, 0.3);  // half vector 72 degrees off the normal

// One lumitexel of one glossy material, photographed once by each of as many views as there are samples.
struct World {
  Model model;
  Observations observations;
  std::vector<ErrorModel> errors{ErrorModel(0.1, 0.002)};
  std::vector<TexelWeights> weights;

  World() {
    Brdf brdf = diffuse_brdf(kAlbedo, kAlbedo, kAlbedo);
    brdf.lobes.emplace_back();
    for (Lobe& lobe : brdf.lobes[0]) lobe = {std::log(5.0), 0.78539816, std::log(50.0)};
    model.materials.push_back({brdf, {brdf}, {}});
    observations.channels = 3;
    weights.push_back({{1.0f}, 0.1f});
    observations.first = {0, 0};
  }

  void see(const LobeGeometry& geometry, const ChannelValues& factor) {
    Observation sample;
    sample.geometry = geometry;
    const ChannelValues truth = predicted_reflectance(model.materials[0].brdf, geometry);
    for (std::size_t c = 0; c < truth.size(); ++c) sample.reflectance[c] = static_cast<float>(factor[c] * truth[c]);
    observations.view.push_back(static_cast<std::uint16_t>(observations.samples.size()));
    observations.samples.push_back(sample);
    observations.first.back() = observations.samples.size();
  }

  Outliers outliers() const { return find_outliers(model, observations, errors, {0}, weights, observations.samples.size()); }
};

TEST(Outliers, ASampleWithinItsErrorIsNone) {
  World world;
  world.see(kMirror, {1.2, 1.1, 0.9});
  EXPECT_TRUE(world.outliers().worst.empty());
}

TEST(Outliers, EachKindIsNamed) {
  World world;
  world.see(kAside, {0.1, 0.1, 0.1});   // a shadow
  world.see(kMirror, {0.3, 0.3, 0.3});  // more than its diffuse light, and no highlight
  world.see(kMirror, {3.0, 3.0, 3.0});
  world.see(kAside, {3.0, 3.0, 3.0});
  world.see(kAside, {2.0, 0.5, 0.5});
  world.see(kAside, {0.6, 0.6, 0.6});   // darker by four scales, all channels alike: no other colour
  world.see(kAside, {1.4, 1.4, 1.4});
  world.see(kAside, {1.0, 1.0, 1.0});
  const Outliers outliers = world.outliers();
  const OutlierReason expected[] = {OutlierReason::Dark, OutlierReason::NoHighlight, OutlierReason::Highlight, OutlierReason::ExtraLight,
                                    OutlierReason::Colour, OutlierReason::Dim, OutlierReason::ExtraLight};
  ASSERT_EQ(outliers.worst.size(), std::size(expected));
  for (std::size_t v = 0; v < std::size(expected); ++v) {
    EXPECT_EQ(outliers.by_view[v][static_cast<std::size_t>(expected[v])], 1u) << to_string(expected[v]);
  }
  for (std::size_t i = 1; i < outliers.worst.size(); ++i) EXPECT_GE(outliers.worst[i - 1].scales, outliers.worst[i].scales);
}

TEST(Outliers, TheTableNamesPhotographAndTexel) {
  World world;
  world.see(kAside, {3.0, 3.0, 3.0});
  const std::string table = outliers_csv(world.outliers(), {"a, \"b\""}, {21}, 8);
  const std::string expected = "# the worst 1 of 1 outliers among 1 samples\nview,texel_x,texel_y,reason,scales,measured,predicted\n\"a, \"\"b\"\"\",5,2,extra light,";
  EXPECT_EQ(table.substr(0, expected.size()), expected);
}

// More of them than are listed: those left off are counted, and are the least of all.
TEST(Outliers, TheTableSaysHowManyItLeavesOff) {
  constexpr std::size_t kMore = 5;
  World world;
  for (std::size_t i = 0; i < kMostOutliersListed + kMore; ++i) world.see(kAside, i < kMore ? ChannelValues{2.0, 2.0, 2.0} : ChannelValues{3.0, 3.0, 3.0});
  const Outliers outliers = world.outliers();
  EXPECT_EQ(total_of(outliers.count), kMostOutliersListed + kMore);
  EXPECT_DOUBLE_EQ(outliers.worst.back().scales, outliers.worst.front().scales);
  const std::string table = outliers_csv(outliers, std::vector<std::string>(kMostOutliersListed + kMore, "a"), {21}, 8);
  EXPECT_EQ(table.substr(0, table.find('\n')), "# the worst 10000 of 10005 outliers among 10005 samples");
  EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), static_cast<std::ptrdiff_t>(kMostOutliersListed) + 2);
}

}  // namespace
}  // namespace lumitexel
