// Physics of microfacet lobes: the same both ways, finite up to grazing, no more light out than in.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/families/known_brdfs.h"

namespace lumitexel {
namespace {

constexpr double kPi = std::numbers::pi;

Eigen::Vector3d direction(double theta, double azimuth) {
  return {std::sin(theta) * std::cos(azimuth), std::sin(theta) * std::sin(azimuth), std::cos(theta)};
}

Brdf lobe_alone(BrdfFamily family, double strength, double alpha) {
  Brdf brdf;
  brdf.family = family;
  brdf.channels = 1;
  brdf.lobes.emplace_back().fill({std::log(strength), std::log(alpha), kMirrorAim});
  return brdf;
}

// The integral of f cos_o over all wo, by half vectors, where the lobe is smooth: dwo = 4 (wi . h) dh.
double albedo(const Brdf& brdf, double theta_i) {
  constexpr int kTilts = 400, kAzimuths = 240;
  const Eigen::Vector3d normal = Eigen::Vector3d::UnitZ(), wi = direction(theta_i, 0.0);
  const double alpha = std::exp(brdf.lobes[0][0].log_shape);
  double sum = 0.0;
  for (int t = 0; t < kTilts; ++t) {
    // u = tan / (tan + alpha) spreads the tilts over the lobe, however narrow.
    const double u = (t + 0.5) / kTilts, tangent = alpha * u / (1.0 - u), tilt = std::atan(tangent);
    const double width = alpha / ((1.0 - u) * (1.0 - u)) / (1.0 + tangent * tangent) / kTilts;
    for (int a = 0; a < kAzimuths; ++a) {
      const Eigen::Vector3d half = direction(tilt, 2.0 * kPi * (a + 0.5) / kAzimuths);
      const double along = wi.dot(half);
      const Eigen::Vector3d wo = 2.0 * along * half - wi;
      if (along <= 0.0 || wo.z() <= 0.0) continue;
      sum += evaluate(brdf, 0, lobe_geometry(normal, wi, wo)) * wo.z() * 4.0 * along * std::sin(tilt) * width * (2.0 * kPi / kAzimuths);
    }
  }
  return sum;
}

class FamilyPhysics : public testing::TestWithParam<BrdfFamily> {};

TEST_P(FamilyPhysics, IsReciprocal) {
  const LobeFamily& family = lobe_family(GetParam());
  for (LobeGeometry g : some_directions(300, 5)) {
    const LobeTerms there = family.terms(std::log(0.2), kMirrorAim, g);
    std::swap(g.cos_i, g.cos_o);
    const LobeTerms back = family.terms(std::log(0.2), kMirrorAim, g);
    EXPECT_NEAR(there.gain, back.gain, 1e-13 * there.gain);
    EXPECT_NEAR(there.offset, back.offset, 1e-13 * there.offset);
  }
}

TEST_P(FamilyPhysics, ReflectsNoMoreThanItGets) {
  constexpr double kIntegration = 2e-3;  // of the midpoint rule above: twice as many points move it by less
  for (const double alpha : {0.02, 0.1, 0.3, 0.6, 1.0}) {
    const Brdf brdf = lobe_alone(GetParam(), 1.0, alpha);
    for (const double theta_deg : {0.0, 20.0, 40.0, 60.0, 75.0, 85.0, 89.0}) {
      const double value = albedo(brdf, theta_deg * kPi / 180.0);
      EXPECT_LE(value, 1.0 + kIntegration) << "alpha " << alpha << " at " << theta_deg;
      EXPECT_GT(value, 0.0);
    }
  }
}

TEST_P(FamilyPhysics, KeepsNearlyAllLightWhereSmooth) {
  // A narrow lobe with full reflectance loses hardly any: what is lost at alpha 0.02 and 20 degrees is below 1 %.
  EXPECT_NEAR(albedo(lobe_alone(GetParam(), 1.0, 0.02), 0.35), 1.0, 0.01);
}

TEST_P(FamilyPhysics, StaysFiniteAtGrazing) {
  for (const double alpha : {0.02, 0.5}) {
    for (const double below_deg : {1.0, 0.1, 0.01}) {
      const double theta = (90.0 - below_deg) * kPi / 180.0;
      const LobeGeometry g = lobe_geometry(Eigen::Vector3d::UnitZ(), direction(theta, 0.0), direction(theta, kPi));
      const LobeSlopes s = lobe_family(GetParam()).slopes(std::log(alpha), kMirrorAim, g);
      for (const double value : {s.gain, s.offset, s.gain_by_shape, s.offset_by_shape}) {
        EXPECT_TRUE(std::isfinite(value));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Microfacets, FamilyPhysics, testing::Values(BrdfFamily::Ggx, BrdfFamily::Ward),
                         [](const auto& family) { return std::string(to_string(family.param)); });

TEST(GgxLobe, NormalReflectanceIsItsStrength) {
  EXPECT_NEAR(albedo(lobe_alone(BrdfFamily::Ggx, 0.04, 0.02), 0.0), 0.04, 4e-4);
}

}  // namespace
}  // namespace lumitexel
