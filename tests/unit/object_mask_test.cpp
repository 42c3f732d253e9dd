#include "processing/calibration/pose/object_mask.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "drivers/error.h"

namespace lumitexel {
namespace {

CameraModel camera() { return {200, 160, 400, 400, 100, 80, 0, 0, 0, 0}; }

// A square of 0.2 m at 1 m: 80 x 80 px, from (60, 40) to (140, 120).
Mesh square() {
  Mesh mesh;
  mesh.positions = {{-0.1, -0.1, 1}, {0.1, -0.1, 1}, {0.1, 0.1, 1}, {-0.1, 0.1, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  return mesh;
}

// A disc of 30 px radius about (100, 80) is the object; a second dark thing lies outside of the mesh.
bool object(int x, int y) { return std::hypot(x + 0.5 - 100, y + 0.5 - 80) < 30; }

MosaicRadiance silhouette(double panel) {
  MosaicRadiance m;
  m.width = 200;
  m.height = 160;
  m.mosaic = Mosaic::Rggb;
  std::mt19937_64 random(1);
  std::normal_distribution<double> noise(0.0, 2.0);
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      const bool dark = object(x, y) || (x < 20 && y < 20);
      const double gain = mosaic_channel(m.mosaic, x, y) == 1 ? 1.0 : 0.7;
      m.value.push_back(static_cast<float>((dark ? 3.0 : gain * panel) + noise(random)));
    }
  }
  m.variance.assign(m.value.size(), 4.0f);
  m.flags.assign(m.value.size(), 0);
  return m;
}

TEST(ObjectMask, FollowsTheSilhouetteWithinTheMesh) {
  const ObjectMask mask = find_object(silhouette(3000.0), square(), camera(), Eigen::Isometry3d::Identity(), 6);
  EXPECT_TRUE(mask.from_silhouette);
  for (int y = 0; y < 160; ++y) {
    for (int x = 0; x < 200; ++x) {
      const double rim = std::abs(std::hypot(x + 0.5 - 100, y + 0.5 - 80) - 30);
      if (rim < 2.0) continue;  // blur and mosaic
      EXPECT_EQ(mask.inside[static_cast<std::size_t>(y * 200 + x)], object(x, y)) << x << ' ' << y;
    }
  }
}

TEST(ObjectMask, WithoutAPanelTheMeshDecides) {
  const ObjectMask mask = find_object(silhouette(3.0), square(), camera(), Eigen::Isometry3d::Identity(), 6);
  EXPECT_FALSE(mask.from_silhouette);
  std::int64_t count = 0;
  for (const std::uint8_t inside : mask.inside) count += inside;
  EXPECT_NEAR(static_cast<double>(count), 80.0 * 80.0, 2 * 4 * 80.0);  // the polygon's rim belongs to it
}

TEST(ObjectMask, AMeshOutOfSightIsBadInput) {
  Eigen::Isometry3d away = Eigen::Isometry3d::Identity();
  away.translation() = Eigen::Vector3d(3.0, 0.0, 0.0);
  EXPECT_THROW(find_object(silhouette(3000.0), square(), camera(), away, 6), BadInput);
  away.translation() = Eigen::Vector3d(0.0, 0.0, -3.0);
  EXPECT_THROW(find_object(silhouette(3000.0), square(), camera(), away, 6), BadInput);
}

}  // namespace
}  // namespace lumitexel
