#include "processing/calibration/pose/silhouette_contour.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "drivers/error.h"
#include "processing/image/linear_sensor.h"

namespace lumitexel {
namespace {

const Eigen::Vector2d kCentre(100.3, 79.6);
constexpr double kRadius = 40.0;

double sampled_share(int x, int y) {
  constexpr int kSide = 16;
  int inside = 0;
  for (int k = 0; k < kSide * kSide; ++k) {
    const Eigen::Vector2d p(x + (k % kSide + 0.5) / kSide, y + (k / kSide + 0.5) / kSide);
    inside += (p - kCentre).norm() < kRadius;
  }
  return static_cast<double>(inside) / (kSide * kSide);
}

double dark_share(int x, int y) {
  static const std::vector<double> shares = [] {
    std::vector<double> all;
    for (int j = 0; j < 160; ++j)
      for (int i = 0; i < 200; ++i) all.push_back(sampled_share(i, j));
    return all;
  }();
  return shares[static_cast<std::size_t>(y * 200 + x)];
}

// A dark disc before a panel that gathers panel_e electrons a pixel (0: no noise), less in red and blue.
MosaicRadiance disc(double panel_e, Mosaic mosaic, std::uint64_t seed = 1) {
  MosaicRadiance m;
  m.width = 200;
  m.height = 160;
  m.mosaic = mosaic;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (int y = 0; y < m.height; ++y) {
    for (int x = 0; x < m.width; ++x) {
      const double gain = mosaic_channel(mosaic, x, y) == 1 || mosaic == Mosaic::Mono ? 1.0 : 0.6;
      // A fifth at the corner of a megapixel picture, of which this is a piece from half-way out.
      const double vignetting = 1.0 - 0.2 * Eigen::Vector2d(x + 200, y + 150).squaredNorm() / (640.0 * 640.0);
      const double value = 0.02 + gain * vignetting * (1.0 - dark_share(x, y));
      const double sigma = panel_e > 0.0 ? std::sqrt(value / panel_e) : 0.0;
      m.value.push_back(static_cast<float>(value + sigma * normal(random)));
      m.variance.push_back(static_cast<float>(sigma * sigma));
    }
  }
  m.flags.assign(m.value.size(), 0);
  return m;
}

double off(const ContourPoint& point) { return (point.pixel - kCentre).norm() - kRadius; }

TEST(SilhouetteContour, LiesOnADiscsRim) {
  for (const Mosaic mosaic : {Mosaic::Mono, Mosaic::Rggb}) {
    const SilhouetteContour contour = silhouette_contour(disc(0.0, mosaic));
    double sum = 0.0, square = 0.0;
    for (const ContourPoint& point : contour.points) {
      sum += off(point);
      square += off(point) * off(point);
      EXPECT_GT(point.normal.dot((point.pixel - kCentre).normalized()), 0.95);
    }
    const auto n = static_cast<double>(contour.points.size());
    EXPECT_GT(n, 200.0);  // the rim is 251 px long; one point per row or column
    // The vignetting's slope across the window and the 16th of a pixel of this picture's sampling leave this.
    EXPECT_LT(std::abs(sum / n), 0.015);
    EXPECT_LT(std::sqrt(square / n), 0.04);
  }
}

TEST(SilhouetteContour, SigmaIsTheScatter) {
  double chi_sq = 0.0, count = 0.0;
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    for (const ContourPoint& point : silhouette_contour(disc(400.0, Mosaic::Mono, seed)).points) {
      chi_sq += std::pow(off(point) / point.sigma_px, 2);
      count += 1.0;
    }
  }
  // 2000 points: the ratio's own scatter is 2 %. The window's variance is taken for that of the levels too.
  EXPECT_NEAR(std::sqrt(chi_sq / count), 1.0, 0.2);
}

TEST(SilhouetteContour, WithoutAPanelThereIsNone) {
  MosaicRadiance dark = disc(400.0, Mosaic::Mono);
  for (float& value : dark.value) value = 0.02f;
  EXPECT_TRUE(silhouette_contour(dark).points.empty());
}

TEST(SilhouetteContour, AClippedPanelIsNamed) {
  MosaicRadiance clipped = disc(400.0, Mosaic::Mono);
  for (std::size_t i = 0; i < clipped.value.size(); ++i) clipped.flags[i] = clipped.value[i] > 0.5f ? kPixelSaturated : 0;
  const SilhouetteContour contour = silhouette_contour(clipped);
  EXPECT_TRUE(contour.points.empty());
  EXPECT_GT(contour.saturated, 0.99);
}

TEST(SilhouetteContour, AMasksRim) {
  std::vector<std::uint8_t> mask;
  for (int y = 0; y < 160; ++y)
    for (int x = 0; x < 200; ++x) mask.push_back(dark_share(x, y) > 0.5);
  double sum = 0.0, square = 0.0, count = 0.0;
  for (const ContourPoint& point : contour_of_mask(mask, 200, 160).points) {
    sum += off(point);
    square += off(point) * off(point);
    count += 1.0;
  }
  EXPECT_GT(count, 200.0);
  EXPECT_LT(std::abs(sum / count), 0.05);
  EXPECT_LT(std::sqrt(square / count), 0.35);  // a pixel's grain: 0.29
}

TEST(SilhouetteContour, NotFiniteIsBadInput) {
  MosaicRadiance broken = disc(0.0, Mosaic::Mono);
  broken.value[77] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(silhouette_contour(broken), BadInput);
}

}  // namespace
}  // namespace lumitexel
