#include "processing/surface/layout_sites.h"

#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

TEST(LayoutSites, EveryTexelOfASquareOnceAtItsOwnPlace) {
  const Mesh mesh = square_mesh();
  const LayoutSites found = layout_sites(mesh, 8, 4);
  ASSERT_EQ(found.sites.size(), 32u);
  EXPECT_EQ(found.contested, 0u);  // centres on the diagonal belong to one, and are no overlap
  for (std::uint32_t i = 0; i < 32; ++i) {
    const LayoutSite& site = found.sites[i];
    EXPECT_EQ(site.texel, i);
    const auto& [a, b, c] = mesh.triangles[site.triangle];
    const Eigen::Vector3d at = (1 - site.u - site.v) * mesh.positions[a] + site.u * mesh.positions[b] + site.v * mesh.positions[c];
    EXPECT_NEAR(at.x(), -1.0 + 2.0 * (i % 8 + 0.5) / 8, 1e-12);
    EXPECT_NEAR(at.y(), 1.0 - 2.0 * (i / 8 + 0.5) / 4, 1e-12);  // the first row is on top
  }
}

TEST(LayoutSites, OverlapIsCountedAndTheFirstTriangleHasTheTexel) {
  Mesh mesh = square_mesh();
  mesh.triangles.push_back({0, 1, 2});
  const LayoutSites found = layout_sites(mesh, 8, 8);
  EXPECT_EQ(found.contested, 28u);  // centres strictly inside the lower triangle: 1 + ... + 7
  for (const LayoutSite& site : found.sites) EXPECT_LT(site.triangle, 2u);
}

TEST(LayoutSites, OnlyWantedTrianglesHoldTexels) {
  const LayoutSites found = layout_sites(square_mesh(), 8, 8, {0, 1});
  for (const LayoutSite& site : found.sites) EXPECT_EQ(site.triangle, 1u);
  EXPECT_EQ(found.sites.size(), 36u);  // 1 + ... + 8: its own and those on the diagonal
}

// A look-up in a triangle reads the four texels around it, so all whose centre is less than a texel away in both directions.
TEST(LayoutSites, LookUpsReadATexelBeyondTheTriangle) {
  Mesh mesh = square_mesh();
  for (Eigen::Vector2d& uv : mesh.texcoords) uv = 0.25 * (Eigen::Vector2d(1, 1) + 2.0 * uv);  // texels 4 to 12 of 16
  std::vector<std::uint8_t> read(256, 0);
  each_texel_read(mesh, 16, 16, {}, [&](std::uint32_t, std::uint32_t texel) { read[texel] = 1; });
  for (std::uint32_t y = 0; y < 16; ++y) {
    for (std::uint32_t x = 0; x < 16; ++x) EXPECT_EQ(read[y * 16 + x], x >= 3 && x <= 12 && y >= 3 && y <= 12) << x << " " << y;
  }
}

}  // namespace
}  // namespace lumitexel
