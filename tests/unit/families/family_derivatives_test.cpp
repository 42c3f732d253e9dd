// Slopes of microfacet lobes against central differences of their values.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/families/known_brdfs.h"

namespace lumitexel {
namespace {

constexpr double kStep = 1e-5;
// A central difference of step h is off by h^2 f'''/6, and its rounding by 1e-16 f / h: some 1e-9 of f with third derivatives of up to a hundred f.
constexpr double kTolerance = 1e-7;

class FamilySlopes : public testing::TestWithParam<BrdfFamily> {};

TEST_P(FamilySlopes, AreTheDerivatives) {
  const LobeFamily& family = lobe_family(GetParam());
  for (const double log_shape : {std::log(0.03), std::log(0.1), std::log(0.3), std::log(0.9)}) {
    for (const LobeGeometry& g : some_directions(400, 3)) {
      const LobeSlopes s = family.slopes(log_shape, kMirrorAim, g);
      const LobeTerms here = family.terms(log_shape, kMirrorAim, g);
      const LobeTerms up = family.terms(log_shape + kStep, kMirrorAim, g), down = family.terms(log_shape - kStep, kMirrorAim, g);
      // A Gaussian far out has slopes many times its value.
      const double scale = std::abs(s.gain) + std::abs(s.gain_by_shape) + std::abs(s.offset) + std::abs(s.offset_by_shape);
      const double steep = 1.0 + half_tangent_squared(g) * std::exp(-2.0 * log_shape);
      const double tolerance = kTolerance * scale * (1.0 + steep * steep * 1e-2) + 1e-300;
      EXPECT_DOUBLE_EQ(s.gain, here.gain);
      EXPECT_DOUBLE_EQ(s.offset, here.offset);
      EXPECT_NEAR(s.gain_by_shape, (up.gain - down.gain) / (2.0 * kStep), tolerance);
      EXPECT_NEAR(s.offset_by_shape, (up.offset - down.offset) / (2.0 * kStep), tolerance);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Microfacets, FamilySlopes, testing::Values(BrdfFamily::Ggx, BrdfFamily::Ward),
                       [](const auto& family) { return std::string(to_string(family.param)); });

}  // namespace
}  // namespace lumitexel
