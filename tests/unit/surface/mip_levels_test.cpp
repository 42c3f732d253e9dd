#include "processing/fit/mip_levels.h"

#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

// A square of 8 x 8 texels, left half of one material and right half of another; weights differ from texel to texel.
Model two_materials() {
  Model model = model_of(square_mesh(), 8, 8, diffuse_brdf(0.1, 0.2, 0.3));
  model.provenance_json = R"({"session_key": "s", "layout": {"from": "mesh"}})";
  const Brdf other = diffuse_brdf(0.3, 0.1, 0.05);
  model.materials.push_back({other, {other}, {}});
  for (std::uint32_t t = 0; t < 64; ++t) {
    model.material[t] = t % 8 >= 3;
    model.weights.data[t] = 0.5f + 0.01f * static_cast<float>(t);
    model.normal.data[3 * t] = t % 2 == 0 ? 0.6f : -0.6f;
    model.normal.data[3 * t + 2] = 0.8f;
  }
  return model;
}

double reflectance(const Model& model, int x, int y, int c) { return evaluate_texel(model, FitStage::Normal, x, y, c, {1.0, 1.0}); }

// Diffuse reflectance does not depend on the normal, so a texel's is the mean of its parts', also where materials meet (column 1).
TEST(MipLevels, AnAveragedTexelReflectsTheMeanOfItsPartsAcrossMaterials) {
  const Model model = two_materials();
  const Model level = averaged_level(model, 1);
  ASSERT_EQ(level.width, 4);
  EXPECT_EQ(level.mesh.texcoords, model.mesh.texcoords);  // the mesh's own layout stays
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 4; ++x) {
      for (int c = 0; c < 3; ++c) {
        const double mean = 0.25 * (reflectance(model, 2 * x, 2 * y, c) + reflectance(model, 2 * x + 1, 2 * y, c) +
                                    reflectance(model, 2 * x, 2 * y + 1, c) + reflectance(model, 2 * x + 1, 2 * y + 1, c));
        EXPECT_NEAR(reflectance(level, x, y, c), mean, 1e-6);
      }
      EXPECT_NEAR(level.normal.at(x, y, 2), 1.0f, 1e-6f);  // tilts cancel, and the mean is a unit vector again
      EXPECT_EQ(level.samples.at(x, y), 28.0f);
    }
  }
}

TEST(MipLevels, KeepWhatTheFitTookOut) {
  Model model = two_materials();
  model.indirect_bounces = 2;
  model.indirect = Image(model.width, model.height, 2, 0.25f);
  model.indirect.at(0, 0, 1) = 0.65f;
  const Model level = averaged_level(model, 1);
  EXPECT_EQ(level.indirect_bounces, 2);
  EXPECT_FLOAT_EQ(level.indirect.at(0, 0, 0), 0.25f);
  EXPECT_FLOAT_EQ(level.indirect.at(0, 0, 1), 0.35f);
}

TEST(MipLevels, TexelsWithoutSamplesCountOnlyWhereThereIsNothingElse) {
  Model model = two_materials();
  for (const int x : {0, 2, 3}) {
    for (const int y : {0, 1}) model.samples.at(x, y) = 0.0f;
  }
  const Model level = averaged_level(model, 1);
  EXPECT_NEAR(reflectance(level, 0, 0, 0), 0.5 * (reflectance(model, 1, 0, 0) + reflectance(model, 1, 1, 0)), 1e-6);
  EXPECT_GT(reflectance(level, 1, 0, 0), 0.0);
  EXPECT_EQ(level.samples.at(1, 0), 0.0f);
}

// Packed anew, each texel still consists of a 2 x 2 block of one chart.
TEST(MipLevels, AnAtlasOfPhotographsIsPackedAnewWithoutMixingCharts) {
  Mesh mesh = square_mesh();
  const Mesh second = square_mesh();
  for (std::uint32_t v = 0; v < 4; ++v) {
    mesh.positions.push_back(second.positions[v] + Eigen::Vector3d(3, 0, 0));
    mesh.normals.push_back(second.normals[v]);
    // Texels 2 to 7 and 9 to 14 of 16: closer than a texel of the coarser level.
    mesh.texcoords.push_back((Eigen::Vector2d(9, 9) + 5.0 * second.texcoords[v]) / 16.0);
    mesh.texcoords[v] = (Eigen::Vector2d(2, 9) + 5.0 * second.texcoords[v]) / 16.0;
  }
  mesh.triangles.push_back({4, 5, 6});
  mesh.triangles.push_back({4, 6, 7});
  for (const int level : {1, 2, 3}) {
    const CoarserLayout layout = coarser_layout(mesh, 16, 16, level, true);
    ASSERT_EQ(layout.parts.size(), 50u);
    std::vector<int> charts(static_cast<std::size_t>(layout.width * layout.height), 0);
    for (const auto& [texel, coarser] : layout.parts) charts[coarser] |= texel % 16 < 8 ? 1 : 2;
    for (const int chart : charts) EXPECT_NE(chart, 3);
  }
}

TEST(MipLevels, ACoarserLumitexelIsTheMeanOfItsPartsWhereHalfOfThemAreSeen) {
  LumitexelSet fine;
  fine.channels = 1;
  LumitexelTile& tile = fine.tiles.emplace_back();
  for (std::uint32_t i = 0; i < 4; ++i) {
    tile.position.emplace_back(i, 0, 0);
    tile.normal.push_back(Eigen::Vector3d::UnitZ());
    tile.texel.push_back(i < 2 ? i : 6 + i);  // the upper left block of 8 x 8
    tile.view.push_back(3);
    tile.reflectance.push_back(static_cast<float>(i));
    tile.variance.push_back(4.0f);
    if (i == 0) {  // seen by one of four alone
      tile.view.push_back(5);
      tile.reflectance.push_back(9.0f);
      tile.variance.push_back(1.0f);
    }
    tile.first_sample.push_back(static_cast<std::uint32_t>(tile.samples()));
  }
  const LumitexelSet coarse = coarser_lumitexels(fine, coarser_layout(square_mesh(), 8, 8, 1, false));
  ASSERT_EQ(coarse.size(), 1u);
  ASSERT_EQ(coarse.samples(), 1u);
  EXPECT_EQ(coarse.tiles[0].view[0], 3);
  EXPECT_EQ(coarse.tiles[0].reflectance[0], 1.5f);
  EXPECT_EQ(coarse.tiles[0].variance[0], 1.0f);
  EXPECT_EQ(coarse.tiles[0].position[0].x(), 1.5);
}

}  // namespace
}  // namespace lumitexel
