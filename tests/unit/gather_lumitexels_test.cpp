#include "processing/surface/gather_lumitexels.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "processing/surface/best_view.h"
#include "tests/unit/sphere_session.h"

namespace lumitexel {
namespace {

// Bilinear sampling between pixels on a 25-pixel radius sphere: the curvature of the shading over half a pixel.
constexpr double kResamplingError = 0.01;

struct Gathered {
  CalibratedSession session;
  std::vector<int> best_view;
  Atlas atlas;
  GatheredLumitexels lumitexels;
};

Gathered gather(std::vector<View> views, const TemporaryFolder& folder) {
  Gathered result;
  result.session = sphere_session(std::move(views), folder);
  const RayScene scene(result.session.mesh);
  result.best_view = choose_best_views(result.session, scene);
  result.atlas = make_atlas(result.session, result.best_view);
  NoProgress progress;
  result.lumitexels = gather_lumitexels(result.session, result.atlas, scene, progress);
  return result;
}

std::vector<View> three_views() {
  return {view_of_origin("near", {0.5, 0, 0}, {0.6, 0.4, 0.3}), view_of_origin("far", {0.8, 0.1, 0}, {0.6, -0.4, 0.3}),
          view_of_origin("side", {0.1, 0.5, 0.1}, {0.4, 0.6, 0.1})};
}

TEST(GatherLumitexels, SamplesAreTheReflectanceOfTheSurface) {
  const TemporaryFolder folder;
  const Gathered gathered = gather(three_views(), folder);
  std::size_t samples = 0;
  for (const LumitexelTile& tile : gathered.lumitexels.set.tiles) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      EXPECT_NEAR(tile.position[i].norm(), 0.1, 1e-3);  // on the sphere, less the facets' sagitta
      for (std::size_t s = tile.first_sample[i]; s < tile.first_sample[i + 1]; ++s, ++samples) {
        const View& view = gathered.session.views[tile.view[s]];
        const double cos_i = tile.normal[i].dot(view.light.direction_from(tile.position[i]));
        EXPECT_NEAR(static_cast<double>(tile.reflectance[3 * s]), kSphereAlbedo / M_PI * cos_i, kResamplingError);
        EXPECT_GT(tile.variance[3 * s], 0.0f);
      }
    }
  }
  EXPECT_GT(samples, 2000u);
}

TEST(GatherLumitexels, OneTexelAPixelOfTheBestView) {
  const TemporaryFolder folder;
  const Gathered gathered = gather(three_views(), folder);
  std::set<std::uint32_t> texels;
  double worst = 0.0;
  for (const LumitexelTile& tile : gathered.lumitexels.set.tiles) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      EXPECT_TRUE(texels.insert(tile.texel[i]).second);
      // The point projects onto a pixel's centre in one of the views: its best.
      double nearest = 1.0;
      for (const View& view : gathered.session.views) {
        const Eigen::Vector2d pixel = view.camera.project(view.camera_from_world * tile.position[i]);
        const Eigen::Vector2d off = pixel - (pixel.array().floor() + 0.5).matrix();
        nearest = std::min(nearest, off.norm());
      }
      worst = std::max(worst, nearest);
    }
  }
  EXPECT_LT(worst, 1e-3);
}

TEST(GatherLumitexels, TheMeshsTextureCoordinatesPointAtTheTexels) {
  const TemporaryFolder folder;
  const Gathered gathered = gather(three_views(), folder);
  for (std::size_t t = 0; t < gathered.atlas.mesh.triangles.size(); ++t) {
    const int patch_index = gathered.atlas.patch_of_triangle[t];
    if (patch_index < 0) continue;
    const AtlasPatch& patch = gathered.atlas.patches[static_cast<std::size_t>(patch_index)];
    const View& view = gathered.session.views[static_cast<std::size_t>(patch.view)];
    for (const std::uint32_t vertex : gathered.atlas.mesh.triangles[t]) {
      const Eigen::Vector2d uv = gathered.atlas.mesh.texcoords[vertex];
      const Eigen::Vector2d texel{uv.x() * gathered.atlas.width, (1.0 - uv.y()) * gathered.atlas.height};
      const Eigen::Vector2d pixel = view.camera.project(view.camera_from_world * gathered.atlas.mesh.positions[vertex]);
      EXPECT_NEAR((texel - pixel - Eigen::Vector2d(patch.shift_x, patch.shift_y)).norm(), 0.0, 1e-9);
    }
  }
}

TEST(GatherLumitexels, HeldOutViewsTakeNoPart) {
  const TemporaryFolder folder;
  std::vector<View> views = three_views();
  views[2].heldout = true;
  const Gathered gathered = gather(views, folder);
  for (const int view : gathered.best_view) EXPECT_NE(view, 2);
  for (const LumitexelTile& tile : gathered.lumitexels.set.tiles) {
    for (const std::uint16_t view : tile.view) EXPECT_NE(view, 2);
  }
}

TEST(GatherLumitexels, FlaggedPixelsShadowsAndEdgesGiveNoSamples) {
  const TemporaryFolder folder;
  Gathered gathered = gather(three_views(), folder);
  const RejectionCounts& rejected = gathered.lumitexels.rejected;
  EXPECT_GT(rejected.in_shadow, 0);
  EXPECT_GT(rejected.hidden, 0);
  EXPECT_EQ(rejected.photograph_flag, 0);

  RadianceImage photograph = read_radiance_image(gathered.session.views[0].photograph);
  std::fill(photograph.flags.begin(), photograph.flags.end(), std::uint8_t{kPixelSaturated});
  write_radiance_image(gathered.session.views[0].photograph, photograph);
  const RayScene scene(gathered.session.mesh);
  NoProgress progress;
  const GatheredLumitexels again = gather_lumitexels(gathered.session, gathered.atlas, scene, progress);
  EXPECT_GT(again.rejected.photograph_flag, 0);
  for (const LumitexelTile& tile : again.set.tiles) {
    for (const std::uint16_t view : tile.view) EXPECT_NE(view, 0);
  }
}

TEST(ChooseBestViews, TakesTheViewThatResolvesTheTriangleBest) {
  const TemporaryFolder folder;
  const CalibratedSession session = sphere_session(
      {view_of_origin("far", {0.9, 0, 0}, {1, 0, 1}), view_of_origin("near", {0.6, 0, 0}, {1, 0, 1})}, folder);
  const RayScene scene(session.mesh);
  const std::vector<int> best = choose_best_views(session, scene);
  int seen = 0, unseen = 0;
  for (std::size_t t = 0; t < best.size(); ++t) {
    const Eigen::Vector3d& corner = session.mesh.positions[session.mesh.triangles[t][0]];
    if (corner.x() > 0.05) {
      EXPECT_EQ(best[t], 1);
      ++seen;
    }
    if (corner.x() < -0.01) {
      EXPECT_EQ(best[t], kUnseen);
      ++unseen;
    }
  }
  EXPECT_GT(seen, 100);
  EXPECT_GT(unseen, 100);
}

}  // namespace
}  // namespace lumitexel
