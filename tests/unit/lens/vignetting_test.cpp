#include "processing/calibration/lens/vignetting.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/unit/bad_input_matcher.h"

namespace lumitexel {
namespace {

CameraModel camera() { return {320, 240, 700.0, 700.0, 168.0, 115.0}; }

struct FlatOptions {
  Eigen::Vector3d terms{-0.3, 0.08, -0.02};
  Eigen::Vector2d gradient{0.05, -0.02};
  bool dust = false;
  Mosaic mosaic = Mosaic::Rggb;
};

MosaicRadiance flat(const FlatOptions& options, std::uint64_t seed) {
  const CameraModel c = camera();
  Vignetting v{c.principal_x_px, c.principal_y_px, 200.0, options.terms, Eigen::Matrix3d::Zero()};
  MosaicRadiance image{320,
                       240,
                       options.mosaic,
                       std::vector<float>(320 * 240),
                       std::vector<float>(320 * 240),
                       std::vector<std::uint8_t>(320 * 240),
                       false,
                       {}};
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (int y = 0; y < 240; ++y) {
    for (int x = 0; x < 320; ++x) {
      const Eigen::Vector2d p(x + 0.5, y + 0.5), off = (p - Eigen::Vector2d(168.0, 115.0)) / 200.0;
      double electrons = 10000.0 * (1.0 + options.gradient.dot(off)) * v.transmission(p) * (((x + y) & 1) ? 1.0 : 0.6);
      if (options.dust && (p - Eigen::Vector2d(80, 60)).norm() < 9) electrons *= 0.93;
      if (options.dust && (p - Eigen::Vector2d(250, 180)).norm() < 6) electrons *= 0.8;
      const std::size_t i = image.index(x, y);
      image.variance[i] = static_cast<float>(electrons);
      image.value[i] = static_cast<float>(electrons + std::sqrt(electrons) * normal(random));
    }
  }
  return image;
}

// The transmission in the corner, where it is least, with dust and tilted light: scatter over stated sigma, known to 1
// / sqrt(80).
TEST(Vignetting, cornerIsRightWithinItsSigmaDespiteDustAndTiltedLight) {
  constexpr int kSeeds = 40;
  const Vignetting truth{168.0, 115.0, 200.0, FlatOptions{}.terms, Eigen::Matrix3d::Zero()};
  const Eigen::Vector2d corner(2, 238);
  double squares = 0;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const auto fit = fit_vignetting({flat({.dust = true}, seed)}, camera());
    ASSERT_TRUE(fit.usable);
    EXPECT_GE(fit.terms, 1);
    EXPECT_LT(fit.cells_left_out, 0.1);
    const double miss = fit.vignetting.transmission(corner) - truth.transmission(corner);
    squares += miss * miss / std::pow(fit.vignetting.sigma(corner), 2);
    EXPECT_LT(std::abs(miss), 0.01);
  }
  const double ratio = std::sqrt(squares / kSeeds);
  std::printf("corner's transmission: scatter / stated %.2f\n", ratio);
  EXPECT_NEAR(ratio, 1.0, 3.3 / std::sqrt(2.0 * kSeeds));
}

TEST(Vignetting, saysNoOfALensWithoutIt) {
  int none = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed)
    none += fit_vignetting({flat({.terms = Eigen::Vector3d::Zero()}, seed)}, camera()).terms == 0;
  std::printf("no vignetting said in %d of 100\n", none);
  EXPECT_GE(none, 95);
}

TEST(Vignetting, correctionMakesAFlatFlatAndScalesItsVariance) {
  const Vignetting truth{168.0, 115.0, 200.0, FlatOptions{}.terms, Eigen::Matrix3d::Zero()};
  MosaicRadiance image = flat({.gradient = {0, 0}, .mosaic = Mosaic::Mono}, 1);
  const float before = image.variance[0];
  correct_vignetting(image, truth);
  const double t = truth.transmission({0.5, 0.5});
  EXPECT_NEAR(image.variance[0] / before, 1.0 / (t * t), 1e-5);
  double corner = 0, middle = 0;
  for (int y = 0; y < 20; ++y) {
    for (int x = 0; x < 20; ++x)
      corner += image.value[image.index(x, y)], middle += image.value[image.index(160 + x, 110 + y)];
  }
  EXPECT_NEAR(corner / middle, 1.0, 5 * std::sqrt(2.0 / (400 * 6000.0)));  // five sigma of the two means
}

TEST(Vignetting, refusesNothingAndOtherSizes) {
  EXPECT_BAD_INPUT(fit_vignetting({}, camera()), "flat fields", "none");
  CameraModel other = camera();
  other.width_px = 640;
  EXPECT_BAD_INPUT(fit_vignetting({flat({}, 1)}, other), "320 x 240", "640 x 240");
  MosaicRadiance saturated = flat({}, 1);
  std::fill(saturated.flags.begin(), saturated.flags.end(), kPixelSaturated);
  EXPECT_FALSE(fit_vignetting({saturated}, camera()).usable);
}

}  // namespace
}  // namespace lumitexel
