// The lamp's radius from rendered spheres: points are called points, discs get their radius within its sigma.
#include "processing/calibration/light/lamp_size.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/unit/light/light_bound.h"
#include "tests/unit/light/rough_spheres.h"

namespace lumitexel {
namespace {

constexpr double kRing_m = 0.04, kPeak = 8000.0;
const Eigen::Vector3d kPivot(0.0, 0.0, 1.0);  // what the lamp faces

RoughSpheres bench(double roughness = 0.025, double blur_px = 0.0) {
  const SphereRig rig = simulated_sphere_rig();
  return {rig.camera, rig.line, roughness, blur_px};
}

PointWidths widths_of(const RoughSpheres& spheres, std::uint64_t seed) {
  const MosaicRadiance clean = picture_of(spheres, ring_of_emitters(kRing_m), kPeak);
  std::vector<HighlightPixel> rings;
  for (int k = 0; k < spheres.line.count; ++k) rings.push_back({k, ring_highlight_pixel(spheres.camera, spheres.line.sphere(k), kRing_m)});
  return measure_point_widths(1, [&](std::size_t) { return with_noise(clean, seed); }, spheres.camera, spheres.line, rings, kRing_m);
}

// A lamp a metre from the pivot, somewhere to the camera's side.
Eigen::Vector3d lamp_place(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::Vector3d away(normal(random), normal(random), -0.2 - 0.5 * std::abs(normal(random)));
  away.z() = std::min(away.z(), -0.3 * away.head<2>().norm());
  return kPivot + away.normalized();
}

LampSize size_of(const RoughSpheres& spheres, const PointWidths& widths, double radius_m, std::uint64_t seed, double most_m = 0.2) {
  const Eigen::Vector3d light = lamp_place(seed);
  const MosaicRadiance picture = with_noise(picture_of(spheres, disc_of_emitters(light, kPivot, radius_m), kPeak), 1000 + seed);
  LampHighlights lamp{{{}}, {light}, kPivot, most_m};
  for (int k = 0; k < spheres.line.count; ++k) {
    const Eigen::Vector2d pixel = highlight_pixel(spheres.camera, spheres.line.sphere(k), light);
    lamp.seen[0].push_back({k, {pixel, kPeak}, std::nullopt});
  }
  return measure_lamp_size(widths, [&](std::size_t) { return picture; }, spheres.camera, spheres.line, lamp);
}

// On rough spheres, and on smooth ones through a lens that blurs more than they do. 95 % of 24 are promised.
TEST(LampSize, OfAPointIsCalledAPoint) {
  int points = 0;
  for (std::uint64_t ring = 0; ring < 4; ++ring) {
    const RoughSpheres spheres = ring % 2 == 0 ? bench() : bench(0.012, 0.8);
    const PointWidths widths = widths_of(spheres, ring);
    for (std::uint64_t seed = 6 * ring; seed < 6 * ring + 6; ++seed) {
      const LampSize size = size_of(spheres, widths, 0.0, seed);
      EXPECT_TRUE(size.measured) << seed;
      points += !size.resolved;
      if (size.resolved) continue;  // counted above
      EXPECT_EQ(size.radius_m, 0.0) << seed;
      EXPECT_LT(size.upper_m, 0.02) << seed;
      EXPECT_GT(size.upper_m, 0.003) << seed;
    }
  }
  EXPECT_GE(points, 23);
}

// The squares of four errors over their sigmas, also through a lens that blurs more than the spheres: below chi-square's one in a
// thousand, and the sigma is no excuse.
TEST(LampSize, OfADiscIsFoundWithinItsSigma) {
  double chi2 = 0.0;
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const RoughSpheres spheres = seed % 2 == 0 ? bench() : bench(0.012, 0.8);
    const LampSize size = size_of(spheres, widths_of(spheres, seed), 0.05, seed);
    EXPECT_TRUE(size.resolved && size.found) << seed;
    EXPECT_LT(size.sigma_m, 0.002) << seed;
    chi2 += std::pow((size.radius_m - 0.05) / size.sigma_m, 2);
  }
  EXPECT_LT(chi2, 18.5);
}

TEST(LampSize, OfADiscAsWideAsItsHighlightsIsStillFound) {
  const LampSize size = size_of(bench(), widths_of(bench(), 1), 0.1, 1);
  EXPECT_TRUE(size.resolved);
  EXPECT_NEAR(size.radius_m, 0.1, 2.0 * size.sigma_m);
  EXPECT_LT(size.sigma_m, 0.01);
}

// No lamp is said to be larger than 3 cm, but this one is.
TEST(LampSize, OfADiscBeyondTheLargestIsNotFound) {
  const LampSize size = size_of(bench(), widths_of(bench(), 1), 0.05, 1, 0.03);
  EXPECT_TRUE(size.resolved);
  EXPECT_FALSE(size.found);
  EXPECT_LE(size.radius_m, 0.03);
}

TEST(LampSize, IsNotMeasuredWhereTooFewSpheresShowIt) {
  const RoughSpheres spheres = bench();
  PointWidths widths = widths_of(spheres, 1);
  for (std::size_t k = 2; k < 6; ++k) widths.log_square[k] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(size_of(spheres, widths, 0.05, 1).measured);
}

}  // namespace
}  // namespace lumitexel
