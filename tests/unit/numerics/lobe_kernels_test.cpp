#include <gtest/gtest.h>

#include <cmath>

#include "processing/brdf/lafortune_base.h"
#include "processing/brdf/numerics/lobe_trials.h"

namespace lumitexel {
namespace {

constexpr double kRounding = 4e-16;

// D as the paper writes it, from cosines; good to rounding, not at the peak.
double plain_base(double phi, const LobeGeometry& g) {
  const double p = g.normal_product(), q = 0.5 * (g.mirror_gap - g.retro_gap);
  return (std::cos(phi) * p - std::sin(phi) * q) / std::max(std::abs(std::sin(phi)), std::cos(phi));
}

TEST(LafortuneBase, IsThePapersAtEveryAim) {
  RandomNumbers random(1);
  for (int i = 0; i < 5000; ++i) {
    const LobeTrial lobe = random_lobe(BrdfFamily::Lafortune, {1.0, 10.0}, random);
    const LobeGeometry geometry = rounded_geometry(random_directions(BrdfFamily::Lafortune, lobe, random));
    const double base = 1.0 - lafortune_aim(lobe.aim).below_one(geometry);
    EXPECT_NEAR(base, plain_base(lobe.aim, geometry), 8.0 * kRounding) << "phi " << lobe.aim;
    EXPECT_NEAR(careful_base(lobe.aim, geometry), base, 8.0 * kRounding) << "phi " << lobe.aim;
    EXPECT_LE(base, 1.0);
  }
}

TEST(LafortuneBase, SlopeIsTheDifferenceQuotient) {
  RandomNumbers random(2);
  constexpr double kStep = 1e-6;
  for (int i = 0; i < 1000; ++i) {
    LobeTrial lobe = random_lobe(BrdfFamily::Lafortune, {1.0, 10.0}, random);
    if (std::abs(std::abs(lobe.aim) - kMirrorAim) < 2.0 * kStep || std::abs(lobe.aim) < 2.0 * kStep) continue;  // kinks
    const LobeGeometry geometry = rounded_geometry(random_directions(BrdfFamily::Lafortune, lobe, random));
    const double quotient =
        (lafortune_aim(lobe.aim - kStep).below_one(geometry) - lafortune_aim(lobe.aim + kStep).below_one(geometry)) / (2.0 * kStep);
    EXPECT_NEAR(lafortune_aim(lobe.aim).slope(geometry), quotient, 1e-8) << "phi " << lobe.aim;
  }
}

TEST(LobeKernels, PeakIsTheStrengthAndBelowZeroIsDark) {
  const auto terms = [](double log_exponent, double phi, const LobeGeometry& geometry) {
    return lobe_family(BrdfFamily::Lafortune).terms(log_exponent, phi, geometry);
  };
  const LobeGeometry mirror = rounded_geometry({0.7, 0.7, 3.141592653589793});
  EXPECT_NEAR(terms(std::log(1e5), kMirrorAim, mirror).gain, 1.0, 1e-10);
  const LobeGeometry opposite = rounded_geometry({1.3, 1.3, 0.0});  // mirror gap 1.86: base below zero
  const LobeSlopes dark = lobe_family(BrdfFamily::Lafortune).slopes(std::log(0.01), kMirrorAim, opposite);
  EXPECT_EQ(dark.gain, 0.0);
  EXPECT_EQ(dark.gain_by_shape, 0.0);
  EXPECT_EQ(dark.gain_by_aim, 0.0);
}

// Cosines as small as numbers get: nothing infinite, nothing that is no number.
TEST(LobeKernels, StayFiniteAtTheSurfacesVeryEdge) {
  for (const BrdfFamily family : {BrdfFamily::Lafortune, BrdfFamily::Ggx, BrdfFamily::Ward}) {
    const LobeFamily& lobe = lobe_family(family);
    for (const double cosine : {1e-4, 1e-20, 1e-100, 1e-160, 5e-324}) {
      for (const double across2 : {0.0, 1e-300, 1e-8, 4.0}) {
        for (const double log_shape : {lobe.least_log_shape, lobe.most_log_shape}) {
          for (const double aim : {-1.5707963267948966, -kMirrorAim, 0.0, kMirrorAim, 1.5707963267948966}) {
            const LobeGeometry geometry{cosine, cosine, 0.5 * across2, 2.0 - 0.5 * across2, across2};
            const LobeSlopes s = lobe.slopes(log_shape, aim, geometry);
            for (const double number : {s.gain, s.offset, s.gain_by_shape, s.offset_by_shape, s.gain_by_aim}) {
              EXPECT_TRUE(std::isfinite(number)) << to_string(family) << " cosine " << cosine << " across2 " << across2;
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace lumitexel
