// Levels fitted anew, on a cube of known albedo whose model is wrong in what a refit has to mend.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "processing/fit/mip_levels.h"
#include "processing/surface/view_geometry.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/sphere_session.h"
#include "tests/unit/surface/unwrapped_cube.h"

namespace lumitexel {
namespace {

constexpr double kSide_m = 0.06;
constexpr int kWidth = 48, kHeight = 32;  // 16 x 16 texels a face
constexpr double kDiffuse = kSphereAlbedo / M_PI;

CalibratedSession cube_session(const TemporaryFolder& folder) {
  return diffuse_session(unwrapped_cube(kSide_m, 0.0),
                         {view_of_origin("corner", {0.16, 0.12, 0.1}, {0.4, 0.5, 0.6}), view_of_origin("high", {0.13, 0.12, 0.14}, {0.5, 0.2, 0.6}),
                          view_of_origin("left", {0.12, 0.16, 0.1}, {0.2, 0.6, 0.4}), view_of_origin("other", {0.15, 0.14, 0.08}, {0.6, 0.3, 0.3})},
                         folder);
}

// The right material, but half of it in every texel.
Model half_as_bright(const CalibratedSession& session) {
  Model model = model_of(session.mesh, kWidth, kHeight, diffuse_brdf(kDiffuse, kDiffuse, kDiffuse));
  std::fill(model.weights.data.begin(), model.weights.data.end(), 0.5f);
  model.provenance_json = R"({"session_key": "diffuse", "layout": {"from": "mesh"}})";
  return model;
}

// The cube photographed, its model, and the samples of the model's texels.
struct Cube {
  TemporaryFolder folder;
  CalibratedSession session = cube_session(folder);
  Model model = half_as_bright(session);
  NoProgress quiet;
  LumitexelSet fine = texel_lumitexels(model, session, quiet);
};

// Largest coordinate: on the cube's surface it is half the side.
double distance_from_cube_m(const Eigen::Vector3d& point) { return std::abs(point.cwiseAbs().maxCoeff() - 0.5 * kSide_m); }

TEST(TexelLumitexels, LieAtTheirTexelsOnTheSurfaceAndHoldItsReflectance) {
  const Cube cube;
  const LumitexelSet& set = cube.fine;
  EXPECT_EQ(set.size(), static_cast<std::size_t>(kWidth * kHeight)) << "the layout covers the whole atlas";
  ASSERT_GT(set.samples(), set.size()) << "three of six faces are seen, by four views";
  for (const LumitexelTile& tile : set.tiles) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      EXPECT_LT(distance_from_cube_m(tile.position[i]), 1e-9);
      EXPECT_NEAR(tile.position[i].dot(tile.normal[i]), 0.5 * kSide_m, 1e-9) << "the face's own normal";
      const int column = static_cast<int>(tile.texel[i]) % kWidth % 16;
      // Along the face's first axis, whose direction the layout knows (unwrapped_cube): texel centres are 1/16 of the side apart.
      Eigen::Index axis = 0;
      tile.normal[i].cwiseAbs().maxCoeff(&axis);
      EXPECT_NEAR(tile.normal[i][axis] * tile.position[i][(axis + 1) % 3], kSide_m * ((column + 0.5) / 16.0 - 0.5), 1e-9);
      for (std::size_t s = tile.first_sample[i]; s < tile.first_sample[i + 1]; ++s) {
        const View& view = cube.session.views[tile.view[s]];
        const double cos_i = tile.normal[i].dot(view.light.direction_from(tile.position[i]));
        // Two thirds of a percent: bilinear sampling of the photograph between pixel centres.
        EXPECT_NEAR(tile.reflectance[3 * s], kDiffuse * cos_i, 0.0067 * kDiffuse);
      }
    }
  }
}

// What levels reflect where they have samples, over what the surface does: least and most.
std::pair<double, double> reflected_share(const Model& level) {
  std::pair<double, double> share{1e9, 0.0};
  for (int y = 0; y < level.height; ++y) {
    for (int x = 0; x < level.width; ++x) {
      if (level.samples.at(x, y) < 1.0f) continue;
      const double here = evaluate_texel(level, FitStage::Normal, x, y, 1, {1.0, 1.0}) / kDiffuse;
      share = {std::min(share.first, here), std::max(share.second, here)};
    }
  }
  return share;
}

TEST(RefittedLevel, FollowsThePhotographsWhereAveragedOnesFollowTheModel) {
  const Cube cube;
  for (const int level : {1, 3}) {
    const Model averaged = averaged_level(cube.model, level);
    EXPECT_NEAR(reflected_share(averaged).first, 0.5, 1e-6);
    const Model refitted = refitted_level(cube.model, averaged, cube.fine, cube.session, level);
    ASSERT_EQ(refitted.width, kWidth >> level);
    EXPECT_EQ(refitted.mesh.texcoords, cube.session.mesh.texcoords);
    const auto [least, most] = reflected_share(refitted);
    // One percent: the photographs' bilinear sampling, and a face's perspective within a texel.
    EXPECT_NEAR(least, 1.0, 0.01) << level;
    EXPECT_NEAR(most, 1.0, 0.01) << level;
    // Faces that no view saw keep a material, without samples.
    EXPECT_EQ(std::count(refitted.material.begin(), refitted.material.end(), Model::kNoMaterial), 0);
    const auto seen = std::count_if(refitted.samples.data.begin(), refitted.samples.data.end(), [](float samples) { return samples > 0.0f; });
    // Three faces of six, but for single texels at their rims, beside which no photograph is sure what it sees.
    constexpr std::ptrdiff_t kAtRims = 4;
    const auto three_faces = static_cast<std::ptrdiff_t>(refitted.material.size()) / 2;
    EXPECT_LE(seen, three_faces);
    EXPECT_GE(seen, three_faces - kAtRims);
  }
}

}  // namespace
}  // namespace lumitexel
