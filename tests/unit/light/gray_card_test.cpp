#include "processing/calibration/light/gray_card.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "drivers/error.h"

namespace lumitexel {
namespace {

struct Bench {
  CameraModel camera{320, 240, 900, 900, 161.0, 118.5, -0.05, 0.02, 0, 0};
  Eigen::Isometry3d camera_from_rig = Eigen::Isometry3d::Identity();
  GrayCardDescription card;
  Eigen::Vector3d light_in_rig{-0.4, -0.6, 0.2};

  Bench() {
    card.albedo = 0.18;
    card.centre_in_rig = {0.03, 0.02, 1.0};
    card.normal_in_rig = Eigen::Vector3d(0.1, -0.3, -1.0);
    card.up_in_rig = Eigen::Vector3d(0.05, -1.0, 0.0);
    card.size_m = 0.08;
  }

  // What the pixel sees of the card's whole plane, straight from the definition of a diffuse surface.
  double radiance(double x, double y, double intensity) const {
    const Eigen::Vector3d n = card.normal_in_rig.normalized(), d = camera.unproject({x, y});
    const Eigen::Vector3d point = d * (card.centre_in_rig.dot(n) / d.dot(n)), to_light = light_in_rig - point;
    const double cosine = to_light.normalized().dot(n);
    return card.albedo / M_PI * intensity * cosine / to_light.squaredNorm();
  }

  MosaicRadiance picture(const std::array<double, 3>& intensity, double relative_noise) const {
    MosaicRadiance m;
    m.width = camera.width_px;
    m.height = camera.height_px;
    m.mosaic = Mosaic::Grbg;
    std::mt19937_64 random(1);
    std::normal_distribution<double> noise(1.0, relative_noise);
    for (int y = 0; y < m.height; ++y) {
      for (int x = 0; x < m.width; ++x) {
        const auto c = static_cast<std::size_t>(mosaic_channel(m.mosaic, x, y));
        m.value.push_back(static_cast<float>(radiance(x + 0.5, y + 0.5, intensity[c]) * noise(random)));
      }
    }
    m.variance.assign(m.value.size(), 1.0f);
    m.flags.assign(m.value.size(), 0);
    return m;
  }
};

TEST(GrayCard, GivesBackTheIntensityExactlyWithoutNoise) {
  const Bench bench;
  const auto measured = measure_gray_card(bench.picture({2e5, 3e5, 1e5}, 0.0), bench.camera, bench.camera_from_rig,
                                          bench.card, bench.light_in_rig);
  ASSERT_EQ(measured.intensity.size(), 3u);
  EXPECT_NEAR(measured.intensity[0] / 2e5, 1.0, 1e-6);  // floats
  EXPECT_NEAR(measured.intensity[1] / 3e5, 1.0, 1e-6);
  EXPECT_NEAR(measured.intensity[2] / 1e5, 1.0, 1e-6);
  // 0.7 of the edge, 0.08 m at 1 m and 900 px: about 50 x 50 px, half of them green.
  EXPECT_NEAR(static_cast<double>(measured.pixels[1]), 0.5 * 50 * 50, 150);
}

TEST(GrayCard, StaysWithinItsSigmaUnderNoiseAndADirtSpot) {
  const Bench bench;
  MosaicRadiance image = bench.picture({2e5, 3e5, 1e5}, 0.02);
  const Eigen::Vector2d centre = bench.camera.project(bench.card.centre_in_rig);
  for (int y = 0; y < 6; ++y) {
    for (int x = 0; x < 6; ++x)
      image.value[image.index(static_cast<int>(centre.x()) + x, static_cast<int>(centre.y()) + y)] *= 0.3f;
  }
  const auto measured = measure_gray_card(image, bench.camera, bench.camera_from_rig, bench.card, bench.light_in_rig);
  const std::array<double, 3> truth{2e5, 3e5, 1e5};
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(measured.intensity[c] / truth[c], 1.0, 5.0 * measured.relative_sigma[c]);
    EXPECT_NEAR(measured.pixel_scatter[c], 0.02, 0.003);
  }
}

TEST(GrayCard, RefusesACardThatCannotBeMeasured) {
  Bench bench;
  const MosaicRadiance image = bench.picture({1, 1, 1}, 0.0);
  const auto measure = [&](const Bench& b, const MosaicRadiance& m) {
    return measure_gray_card(m, b.camera, b.camera_from_rig, b.card, b.light_in_rig);
  };
  MosaicRadiance saturated = image;
  std::fill(saturated.flags.begin(), saturated.flags.end(), kPixelSaturated);
  EXPECT_THROW(measure(bench, saturated), BadInput);
  Bench away = bench;
  away.card.normal_in_rig = -away.card.normal_in_rig;
  EXPECT_THROW(measure(away, image), BadInput);
  Bench behind = bench;
  behind.light_in_rig = {0.0, 0.0, 2.0};
  EXPECT_THROW(measure(behind, image), BadInput);
  Bench outside = bench;
  outside.card.centre_in_rig = {0.3, 0.02, 1.0};
  EXPECT_THROW(measure(outside, image), BadInput);
}

}  // namespace
}  // namespace lumitexel
