#include "processing/surface/given_layout.h"

#include <cmath>

#include "processing/evaluation/evaluate_model.h"
#include "processing/fit/fit_model.h"
#include "processing/model/model_file.h"
#include "processing/report/viewer/lumitexel_records.h"
#include "processing/surface/best_view.h"
#include "processing/surface/gather_lumitexels.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/sphere_session.h"
#include "tests/unit/surface/unwrapped_cube.h"

namespace lumitexel {
namespace {

constexpr double kGutter = 0.02;

// Close enough that perspective bends the picture of a face by pixels.
std::vector<View> cube_views() {
  return {view_of_origin("corner", {0.16, 0.12, 0.1}, {0.4, 0.5, 0.6}), view_of_origin("back", {-0.14, -0.1, 0.12}, {-0.5, -0.4, 0.5}),
          view_of_origin("corner left", {0.12, 0.16, 0.1}, {0.2, 0.6, 0.4}), view_of_origin("corner high", {0.13, 0.12, 0.14}, {0.5, 0.2, 0.6}),
          view_of_origin("low", {0.1, -0.12, -0.15}, {0.4, -0.5, -0.4}), view_of_origin("other", {0.15, 0.14, 0.08}, {0.6, 0.3, 0.3})};
}

CalibratedSession cube_session(const TemporaryFolder& folder, double gutter = kGutter) {
  std::vector<View> views = cube_views();
  views.back().heldout = true;
  return diffuse_session(unwrapped_cube(0.06, gutter), views, folder);
}

struct LaidOut {
  LayoutSummary summary;
  Atlas atlas;
  LumitexelSet lumitexels;
};

LaidOut lay(const CalibratedSession& session, const LayoutOptions& options) {
  const RayScene scene(session.mesh);
  LaidOut result;
  result.atlas = lay_out(session, choose_best_views(session, scene), options, result.summary);
  NoProgress progress;
  result.lumitexels = gather_lumitexels(session, result.atlas, scene, progress).set;
  return result;
}

// How far from the texel's centre a model's user looks the surface point up, in texels. On a cube's edge there are several places: the nearest.
double look_up_error(const Atlas& atlas, const Eigen::Vector3d& point, const Eigen::Vector2d& centre) {
  constexpr double kOnTriangle = 1e-4;  // barycentric
  double nearest = std::numeric_limits<double>::infinity();
  for (const auto& [a, b, c] : atlas.mesh.triangles) {
    const Eigen::Vector3d& origin = atlas.mesh.positions[a];
    Eigen::Matrix<double, 3, 2> sides;
    sides << atlas.mesh.positions[b] - origin, atlas.mesh.positions[c] - origin;
    const Eigen::Vector2d at = sides.colPivHouseholderQr().solve(point - origin);
    if (at.minCoeff() < -kOnTriangle || at.sum() > 1 + kOnTriangle || (origin + sides * at - point).norm() > 1e-6) continue;
    const Eigen::Vector2d uv = (1 - at.sum()) * atlas.mesh.texcoords[a] + at.x() * atlas.mesh.texcoords[b] + at.y() * atlas.mesh.texcoords[c];
    nearest = std::min(nearest, (Eigen::Vector2d(uv.x() * atlas.width, (1 - uv.y()) * atlas.height) - centre).norm());
  }
  return nearest;
}

double worst_look_up(const LaidOut& laid) {
  double worst = 0.0;
  for (const LumitexelTile& tile : laid.lumitexels.tiles) {
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const auto width = static_cast<std::uint32_t>(laid.atlas.width);
      const Eigen::Vector2d centre(tile.texel[i] % width + 0.5, tile.texel[i] / width + 0.5);
      worst = std::max(worst, look_up_error(laid.atlas, tile.position[i], centre));
    }
  }
  return worst;
}

// The two triangles of a face this close miss the picture by several pixels: the model would show every point beside its place.
TEST(Atlas, LumitexelsLieWhereTheyAreLookedUpAlsoOnLargeTriangles) {
  const TemporaryFolder folder;
  const LaidOut laid = lay(cube_session(folder), {LayoutChoice::Photographs});
  EXPECT_GT(laid.lumitexels.size(), 5000u);
  EXPECT_GT(laid.summary.lumitexels_at_texels, 5000u);
  EXPECT_LE(worst_look_up(laid), kLookUpTolerance);
}

TEST(GivenLayout, IsKeptBitForBitAndLumitexelsLieAtTexels) {
  const TemporaryFolder folder;
  const CalibratedSession session = cube_session(folder);
  const LaidOut laid = lay(session, {LayoutChoice::Auto});
  EXPECT_TRUE(laid.summary.of_mesh);
  EXPECT_EQ(laid.atlas.mesh.texcoords, session.mesh.texcoords);
  EXPECT_EQ(laid.atlas.mesh.triangles, session.mesh.triangles);
  EXPECT_LT(worst_look_up(laid), 1e-6);
  EXPECT_NEAR(laid.summary.pixels_a_texel[1], 1.0, 0.01);
  EXPECT_LE(laid.summary.pixels_a_texel[0], laid.summary.pixels_a_texel[1]);
  EXPECT_EQ(laid.summary.shared_texels, 0u);
  EXPECT_EQ(lay(session, {LayoutChoice::Mesh, 100}).atlas.width, 100);
}

TEST(GivenLayout, ChartsThatTouchAreSaidToBleed) {
  const TemporaryFolder folder;
  EXPECT_GT(lay(cube_session(folder, 0.0), {LayoutChoice::Mesh}).summary.shared_texels, 100u);
}

TEST(GivenLayout, OneThatIsNoMapIsRefusedByNameAndReplacedAloud) {
  const TemporaryFolder folder;
  CalibratedSession session = cube_session(folder);
  const Mesh good = session.mesh;
  const auto refused = [&](const std::string& why) {
    EXPECT_BAD_INPUT(lay(session, {LayoutChoice::Mesh}), "layout", why);
    const LaidOut laid = lay(session, {LayoutChoice::Auto});
    EXPECT_FALSE(laid.summary.of_mesh);
    EXPECT_FALSE(laid.atlas.patches.empty());
    return laid.summary.refused;
  };
  for (std::size_t v = 20; v < 24; ++v) session.mesh.texcoords[v] = session.mesh.texcoords[v - 20];
  EXPECT_NE(refused("overlap").find("overlap"), std::string::npos);
  session.mesh = good;
  session.mesh.texcoords[3].x() = -0.2;
  EXPECT_NE(refused("outside [0, 1]").find("1 of its texture coordinates"), std::string::npos);
  session.mesh = good;
  session.mesh.texcoords[2] = session.mesh.texcoords[1];
  EXPECT_NE(refused("no area").find("(1 triangles)"), std::string::npos);
  session.mesh = good;
  session.mesh.texcoords.clear();
  EXPECT_EQ(refused("no texture coordinates"), "");  // nothing to say where nobody gave one
}

double heldout_error(const CalibratedSession& session, LayoutChoice choice, const TemporaryFolder& folder) {
  FitOptions options = FitOptions::preset("draft");
  options.materials = 1;
  options.normals = NormalChoice::Mesh;
  options.layout.choice = choice;
  NoProgress progress;
  const FittedModel fitted = fit_model(session, options, StageTimer(), progress);
  write_model(folder / to_string(choice), fitted.model);
  const Model model = read_model(folder / to_string(choice));
  if (choice == LayoutChoice::Mesh) {
    EXPECT_EQ(model.mesh.texcoords, session.mesh.texcoords);
  }
  EXPECT_EQ(lumitexel_records(model, session, progress).texel.size(), fitted.summary.lumitexels) << "the viewer finds the fit's lumitexels again";
  return evaluate_model(model, session, progress).heldout[static_cast<std::size_t>(FitStage::Projection)]->sqrt_rms;
}

// Nothing but where texels lie is different. The photographs are exact, so what is left is the rim of the object and of shadows, in
// both alike: a hundredth of the radiance's root, well above what bilinear reading costs.
TEST(GivenLayout, PredictsHeldOutPhotographsAsWellAsAnAtlasOfPhotographs) {
  constexpr double kSame = 0.01;
  const TemporaryFolder folder;
  const CalibratedSession session = cube_session(folder);
  EXPECT_NEAR(heldout_error(session, LayoutChoice::Mesh, folder), heldout_error(session, LayoutChoice::Photographs, folder), kSame);
}

}  // namespace
}  // namespace lumitexel
