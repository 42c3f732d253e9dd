// Which known material a BRDF is nearest to.
#include "processing/brdf/nearest_material.h"

#include <gtest/gtest.h>

#include "tests/unit/families/known_brdfs.h"

namespace lumitexel {
namespace {

KnownMaterial named(std::string name, const Brdf& brdf) {
  return {std::move(name), [brdf](const LobeGeometry& geometry) { return evaluate(brdf, geometry); }};
}

TEST(NearestMaterial, FindsItselfAtDistanceZeroAndTheSharperOneNext) {
  const std::vector<KnownMaterial> known{named("matte", known_brdf(BrdfFamily::Ward, {})),
                                         named("satin", known_brdf(BrdfFamily::Ward, {{0.05, 0.3}})),
                                         named("gloss", known_brdf(BrdfFamily::Ward, {{0.05, 0.05}}))};
  const auto nearest = nearest_materials(known_brdf(BrdfFamily::Ward, {{0.05, 0.05}}), known);
  ASSERT_EQ(nearest.size(), 3u);
  EXPECT_EQ(known[nearest[0].index].name, "gloss");
  EXPECT_EQ(nearest[0].distance, 0.0);
  EXPECT_GT(nearest[1].distance, 0.0);
  EXPECT_GE(nearest[2].distance, nearest[1].distance);
}

TEST(NearestMaterial, DistanceIsOfCubeRootsForDiffuseLight) {
  const BrdfValues black = [](const LobeGeometry&) { return ChannelValues{}; };
  const BrdfValues gray = [](const LobeGeometry& g) { return ChannelValues{0.008 / g.cos_i, 0.008 / g.cos_i, 0.008 / g.cos_i}; };
  EXPECT_NEAR(material_distance(black, gray, 3), 0.2, 1e-12);
  EXPECT_DOUBLE_EQ(material_distance(black, gray, 3), material_distance(gray, black, 3));
}

}  // namespace
}  // namespace lumitexel
