#include "processing/render/environment.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "processing/image/exr_file.h"
#include "processing/render/sample_sequence.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/render/skies.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

constexpr double kPi = std::numbers::pi;

// 4 x 2 pixels, each with a value of its own: 0 to 3 above, 4 to 7 below.
Environment numbered(const Eigen::Matrix3d& turn = Eigen::Matrix3d::Identity()) {
  Image image(4, 2, 1);
  for (std::size_t i = 0; i < 8; ++i) image.data[i] = static_cast<float>(i);
  return Environment(std::move(image), turn, "numbered");
}

TEST(Environment, LooksWhereItsHeaderSays) {
  const Environment sky = numbered();
  const auto value = [&](double x, double y, double z) {
    return sky.radiance(Eigen::Vector3d(x, y, z).normalized(), 0);
  };
  // Columns from left to right: azimuths 180 to 90, 90 to 0, 0 to -90, -90 to -180 degrees.
  EXPECT_EQ(value(-1, 0.1, 0.1), 0) << "left edge: behind, a little to the left";
  EXPECT_EQ(value(1, 0.1, 0.1), 1) << "left of the middle is towards +y";
  EXPECT_EQ(value(1, -0.1, 0.1), 2);
  EXPECT_EQ(value(-1, -0.1, 0.1), 3);
  EXPECT_EQ(value(1, 0.1, -0.1), 5) << "below";
}

TEST(Environment, IsLiftedAndTurned) {
  const auto value = [](const Eigen::Matrix3d& turn, const Eigen::Vector3d& d) {
    return numbered(turn).radiance(d.normalized(), 0);
  };
  // A quarter turn counter-clockwise: what lay ahead at +x now lies at +y.
  EXPECT_EQ(value(environment_from_world(Eigen::Vector3d::UnitZ(), kPi / 2), {-0.1, 1, 0.1}), 1);
  EXPECT_EQ(value(environment_from_world(Eigen::Vector3d::UnitZ(), kPi / 2), {0.1, 1, 0.1}), 2);
  // With y up, z becomes y and y becomes -z; x stays ahead.
  EXPECT_EQ(value(environment_from_world(Eigen::Vector3d::UnitY(), 0), {1, 0.1, -0.1}), 1);
  EXPECT_EQ(value(environment_from_world(Eigen::Vector3d::UnitY(), 0), {1, -0.1, 0.1}), 6);
  // Upside down, about x.
  EXPECT_EQ(value(environment_from_world(-Eigen::Vector3d::UnitZ(), 0), {1, -0.1, -0.1}), 1);
  EXPECT_BAD_INPUT(environment_from_world(Eigen::Vector3d::Zero(), 0), "up");
}

TEST(Environment, DensityIntegratesToOneAndFollowsTheLight) {
  const Environment sky = uneven_sky(16, 8);
  constexpr int kSide =
      512;  // a whole number of points to a pixel: the midpoint rule is then exact but for the rows' areas
  double total = 0.0, bright = 0.0, dim = 0.0;
  for (int i = 0; i < kSide; ++i) {
    for (int j = 0; j < kSide; ++j) {
      const double polar = kPi * (j + 0.5) / kSide, azimuth = 2 * kPi * (i + 0.5) / kSide;
      const Eigen::Vector3d d(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                              std::cos(polar));
      total += sky.density(d) * std::sin(polar) * 2 * kPi * kPi / (kSide * kSide);
      if (sky.radiance(d, 0) == 20.0f) bright = sky.density(d);
      if (sky.radiance(d, 0) == 0.05f) dim = sky.density(d);
    }
  }
  EXPECT_NEAR(total, 1.0, 1e-4);
  EXPECT_NEAR(bright / dim, 25.0 / 0.05, 1e-3 * 500) << "the mean of the channels: 25 against 0.05";
}

// How often directions fall into a cell against the density there, over cells that are no pixels of the picture.
TEST(Environment, DirectionsAreDrawnWithTheirDensity) {
  const Environment sky = uneven_sky(12, 6);
  constexpr int kSamples = 1 << 16;
  double mean_inverse = 0.0;
  Eigen::Vector3d flux = Eigen::Vector3d::Zero();
  for (int i = 0; i < kSamples; ++i) {
    SampleSequence numbers(3, 5, 0, static_cast<std::uint32_t>(i));
    const Eigen::Vector3d d = sky.sample(numbers.next());
    ASSERT_NEAR(d.norm(), 1.0, 1e-12);
    const double density = sky.density(d);
    ASSERT_GT(density, 0.0);
    mean_inverse += 1.0 / density / kSamples;
    flux += d * sky.radiance(d, 1) / density / kSamples;
  }
  // Quadrature of the same flux, pixel by pixel.
  Eigen::Vector3d expected = Eigen::Vector3d::Zero();
  double lit = 0.0;
  constexpr int kSide = 1200;
  for (int j = 0; j < kSide; ++j) {
    for (int i = 0; i < kSide; ++i) {
      const double polar = kPi * (j + 0.5) / kSide, azimuth = 2 * kPi * (i + 0.5) / kSide;
      const Eigen::Vector3d d(std::sin(polar) * std::cos(azimuth), std::sin(polar) * std::sin(azimuth),
                              std::cos(polar));
      const double area = std::sin(polar) * 2 * kPi * kPi / (kSide * kSide);
      expected += d * sky.radiance(d, 1) * area;
      if (sky.density(d) > 0.0) lit += area;
    }
  }
  // 65,536 stratified points of a bounded function: errors of 1 / sqrt(N) times its spread would be 2 %.
  EXPECT_NEAR(mean_inverse, lit, 0.005 * lit);
  EXPECT_LT((flux - expected).norm(), 0.005 * expected.norm()) << flux.transpose() << " / " << expected.transpose();
}

TEST(Environment, FilesAreScaledAndCheckedByName) {
  const TemporaryFolder folder;
  const auto file = folder / "sky.exr";
  const Eigen::Matrix3d straight = Eigen::Matrix3d::Identity();
  write_exr_colour(file, Image(4, 2, 3, 0.5f));
  EXPECT_EQ(read_environment(file, 3.0, straight, 3).radiance(Eigen::Vector3d::UnitX(), 1), 1.5);
  EXPECT_BAD_INPUT(read_environment(file, 1.0, straight, 1), "sky.exr", "3 channels");
  EXPECT_BAD_INPUT(read_environment(file, 0.0, straight, 3), "scale");
  write_exr_colour(file, Image(4, 2, 1, 0.5f));
  EXPECT_EQ(read_environment(file, 1.0, straight, 3).radiance(Eigen::Vector3d::UnitX(), 2), 0.5)
      << "gray for all channels";
  Image image(4, 2, 3, 0.5f);
  image.at(2, 1, 0) = std::numeric_limits<float>::quiet_NaN();
  write_exr_colour(file, image);
  EXPECT_BAD_INPUT(read_environment(file, 1.0, straight, 3), "sky.exr", "pixel 2, 1");
  image.at(2, 1, 0) = -1.0f;
  write_exr_colour(file, image);
  EXPECT_BAD_INPUT(read_environment(file, 1.0, straight, 3), "pixel 2, 1", "-1");
  write_exr_colour(file, Image(4, 2, 3));
  EXPECT_BAD_INPUT(read_environment(file, 1.0, straight, 3), "no light");
}

}  // namespace
}  // namespace lumitexel
