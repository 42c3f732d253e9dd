#include "processing/fit/fill_atlas.h"

#include <gtest/gtest.h>

#include "processing/model/model_surface.h"
#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

constexpr int kSize = 12, kFirst = 4, kEnd = 8;  // the patch: texels of [kFirst, kEnd) in both directions
const Eigen::Vector3d kTilted = Eigen::Vector3d(0.1, -0.2, 1.0).normalized();

// One patch, the square, in the middle of an atlas; all its lumitexels tilted alike. Texel (0, 0) is of surface that no view saw.
struct Patch {
  Atlas atlas;
  LumitexelSet lumitexels;

  Patch() {
    atlas.width = atlas.height = kSize;
    atlas.mesh = square_mesh();
    for (Eigen::Vector2d& at : atlas.mesh.texcoords) at = (Eigen::Vector2d::Constant(kFirst) + (kEnd - kFirst) * at) / kSize;
    lumitexels.channels = 3;
    LumitexelTile& tile = lumitexels.tiles.emplace_back();
    for (int y = kFirst; y < kEnd; ++y) {
      for (int x = kFirst; x < kEnd; ++x) {
        tile.texel.push_back(static_cast<std::uint32_t>(y * kSize + x));
        tile.position.push_back(Eigen::Vector3d::Zero());
        tile.normal.push_back(kTilted);
        const bool starved = x == kFirst && y == kFirst;
        if (!starved) {
          tile.view.push_back(0);
          tile.reflectance.insert(tile.reflectance.end(), 3, 0.1f);
          tile.variance.insert(tile.variance.end(), 3, 0.0f);
        }
        tile.first_sample.push_back(static_cast<std::uint32_t>(tile.view.size()));
      }
    }
  }

  Model filled(bool on_fitted_normals) const {
    Model model;
    const Brdf brdf = diffuse_brdf(0.1, 0.1, 0.1);
    model.materials = {{brdf, {brdf}}};
    if (on_fitted_normals) model.before_normals = ReflectanceLayer{};
    fill_atlas(atlas, lumitexels, std::vector<int>(lumitexels.size(), 0), std::vector<TexelWeights>(lumitexels.size(), {{1.0f}, 0.1f}), {}, model);
    return model;
  }
};

bool has_normal(const Model& model, int x, int y) { return model.normal.at(x, y, 2) != 0.0f; }

// The points of the square along one of its sides, at its very border.
std::vector<TexturedPoint> border_points(const ModelSurface& surface) {
  std::vector<TexturedPoint> points;
  for (double along = -0.99; along < 1.0; along += 0.09) {
    for (const auto& [x, y] : {std::pair{along, 0.999}, {along, -0.999}, {0.999, along}, {-0.999, along}}) {
      points.push_back(*surface.trace({x, y, 1.0}, -Eigen::Vector3d::UnitZ()));
    }
  }
  return points;
}

TEST(FillAtlas, LookUpsAtAPatchsBorderStayOnFittedNormals) {
  const Model model = Patch().filled(true);
  const ModelSurface surface(model);
  std::size_t beside = 0;
  for (const TexturedPoint& point : border_points(surface)) {
    for (int i = 0; i < point.texel_count; ++i) {
      const TexelShare& texel = point.texels[static_cast<std::size_t>(i)];
      EXPECT_LT((surface.shading_normal(texel, point, FitStage::Normal) - kTilted).norm(), 1e-6) << texel.x << ", " << texel.y;  // floats
      beside += model.samples.at(texel.x, texel.y) == 0.0f;
    }
  }
  EXPECT_GT(beside, 50u) << "else no look-up went beside the patch";
}

TEST(FillAtlas, NormalsEndTwoTexelsBesideAPatchAndBeforeUnseenSurface) {
  Patch patch;
  patch.atlas.unseen_texels = {0, kFirst * kSize + kEnd};  // one of them right beside the patch
  const Model model = patch.filled(true);
  EXPECT_TRUE(has_normal(model, kEnd + 1, kEnd - 1));
  EXPECT_FALSE(has_normal(model, kEnd + 2, kEnd - 1));
  EXPECT_TRUE(has_normal(model, kFirst - 1, kFirst - 1)) << "beside a lumitexel without samples, too";
  EXPECT_FALSE(has_normal(model, kEnd, kFirst));
  EXPECT_FALSE(has_normal(model, 0, 0));
}

// The mesh's own normal, interpolated at the point itself, is better than a neighbour's of the mesh.
TEST(FillAtlas, OnTheMeshsNormalsNothingIsCopied) {
  const Model model = Patch().filled(false);
  EXPECT_TRUE(has_normal(model, kEnd - 1, kEnd - 1));
  EXPECT_FALSE(has_normal(model, kEnd, kEnd - 1));
}

}  // namespace
}  // namespace lumitexel
