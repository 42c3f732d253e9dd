#include "processing/model/render_view.h"

#include <gtest/gtest.h>

#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

// What is left when only single-precision storage and ray casting stand between the renderer and the closed form.
constexpr double kRounding = 2e-6;

// First intersection of a ray with the unit sphere; the origin is outside.
std::optional<Eigen::Vector3d> on_unit_sphere(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  const double b = origin.dot(direction), discriminant = b * b - origin.squaredNorm() + 1.0;
  if (discriminant < 0.0) return std::nullopt;
  return origin + (-b - std::sqrt(discriminant)) * direction;
}

TEST(RenderView, ADiffuseSphereHasItsClosedFormRadiance) {
  const Model model = model_of(sphere_mesh(400, 200), 16, 8, diffuse_brdf(0.1, 0.2, 0.3));
  View view = view_from_above(64, 4.0);
  view.light.type = Light::Type::Point;
  view.light.vector_in_world = {2.0, 1.0, 3.0};
  view.light.intensity = {5.0, 6.0, 7.0};
  const RenderedView rendered = ViewRenderer(model).render(view, {});
  // 400 segments: the facets lie up to 3e-5 below the sphere, which moves a point sideways by that over cos(view);
  // normals are interpolated to second order. Rim and terminator, where this is divided by a small cosine, are left
  // out.
  constexpr double kFacets = 1e-3, kRim = 0.2;
  int compared = 0;
  const Eigen::Isometry3d world_from_camera = view.camera_from_world.inverse();
  for (int y = 0; y < 64; ++y) {
    for (int x = 0; x < 64; ++x) {
      const Eigen::Vector3d ray = world_from_camera.linear() * view.camera.unproject({x + 0.5, y + 0.5});
      const auto point = on_unit_sphere(world_from_camera.translation(), ray);
      if (!point) {
        EXPECT_EQ(rendered.radiance.at(x, y, 0), 0.0f);
        continue;
      }
      const Eigen::Vector3d to_light = view.light.vector_in_world - *point;
      const double cos_i = point->dot(to_light.normalized());
      if (cos_i < -kRim) {
        EXPECT_EQ(rendered.radiance.at(x, y, 1), 0.0f);
      }
      if (cos_i < kRim || -point->dot(ray) < kRim) continue;
      ++compared;
      for (int c = 0; c < 3; ++c) {
        const double expected = (0.1 + 0.1 * c) * cos_i * (5.0 + c) / to_light.squaredNorm();
        EXPECT_NEAR(rendered.radiance.at(x, y, c), expected, kFacets * expected) << x << " " << y;
      }
    }
  }
  EXPECT_GT(compared, 500);
}

TEST(RenderView, ATexelsOwnNormalIsUsed) {
  Model model = model_of(square_mesh(), 4, 4, diffuse_brdf(0.5, 0.5, 0.5));
  const Eigen::Vector3f tilted = Eigen::Vector3f(0.6f, 0.0f, 0.8f);
  for (std::size_t t = 0; t < 16; ++t) std::copy(tilted.data(), tilted.data() + 3, &model.normal.data[3 * t]);
  View view = view_from_above(8, 5.0);
  view.light.vector_in_world = Eigen::Vector3d(-0.6, 0.0, 0.8);
  const ViewRenderer renderer(model);
  EXPECT_NEAR(renderer.render(view, {}).radiance.at(3, 3), 0.5 * (0.64 - 0.36), kRounding);
  const Image normal = renderer.render_aov(view, Aov::Normal);
  EXPECT_NEAR(normal.at(3, 3, 0), 0.6, kRounding);
  EXPECT_NEAR(normal.at(3, 3, 2), 0.8, kRounding);
}

// The roof at z = 0.5 over x in [0.4, 0.6] casts a shadow of the same width, shifted by the light's slope.
TEST(RenderView, AShadowFallsWhereGeometrySaysAndIsBlack) {
  Mesh mesh = square_mesh();
  mesh.positions.insert(mesh.positions.end(), {{0.4, -2, 0.5}, {0.6, -2, 0.5}, {0.6, 2, 0.5}, {0.4, 2, 0.5}});
  mesh.texcoords.insert(mesh.texcoords.end(), 4, {0.5, 0.5});
  mesh.normals.insert(mesh.normals.end(), 4, Eigen::Vector3d::UnitZ());
  mesh.triangles.insert(mesh.triangles.end(), {{4, 5, 6}, {4, 6, 7}});
  const Model model = model_of(std::move(mesh), 4, 4, diffuse_brdf(0.5, 0.5, 0.5));
  constexpr int kSize = 200;
  View view = view_from_above(kSize, 1000.0);  // far away: rays all but parallel, the roof hides what is below it
  view.light.vector_in_world = Eigen::Vector3d(1.0, 0.0, 1.0).normalized();
  const Image radiance = ViewRenderer(model).render(view, {}).radiance;
  for (int px = 0; px < kSize; ++px) {
    const double x = 2.0 * (px + 0.5) / kSize - 1.0;
    const bool shadowed = x > -0.1 && x < 0.1;  // 0.4 - 0.5 to 0.6 - 0.5
    EXPECT_NEAR(radiance.at(px, kSize / 2), shadowed ? 0.0 : 0.5 * std::sqrt(0.5), kRounding) << x;
  }
}

TEST(RenderView, ALightBehindTheSurfaceDoesNotReachIt) {
  Model model = model_of(square_mesh(), 1, 1, diffuse_brdf(1, 1, 1));
  // The normal map leans towards a light that the triangle itself turns its back on.
  const Eigen::Vector3f leaning(0.8f, 0.0f, 0.6f);
  std::copy(leaning.data(), leaning.data() + 3, model.normal.data.begin());
  View view = view_from_above(8, 5.0);
  view.light.vector_in_world = Eigen::Vector3d(1.0, 0.0, -0.1).normalized();
  EXPECT_EQ(ViewRenderer(model).render(view, {}).radiance.at(4, 4), 0.0f);
}

TEST(RenderView, TexelsAreBlendedBilinearly) {
  Model model = model_of(square_mesh(), 2, 2, diffuse_brdf(0, 0, 0));
  model.materials = {{diffuse_brdf(0.2, 0.2, 0.2), {diffuse_brdf(0.2, 0.2, 0.2)}},
                     {diffuse_brdf(0.8, 0.8, 0.8), {diffuse_brdf(0.8, 0.8, 0.8)}}};
  model.material = {0, 1, 0, 0};  // the top right texel is the bright one
  constexpr int kSize = 40;
  const View view = view_from_above(kSize, 5.0);
  const Image radiance = ViewRenderer(model).render(view, {}).radiance;
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      // Between the texel centres at a quarter and three quarters of the picture; constant beyond them.
      const double right = std::clamp(2.0 * (x + 0.5) / kSize - 0.5, 0.0, 1.0);
      const double down = std::clamp(2.0 * (y + 0.5) / kSize - 0.5, 0.0, 1.0);
      EXPECT_NEAR(radiance.at(x, y), 0.2 + 0.6 * right * (1.0 - down), kRounding) << x << " " << y;
    }
  }
}

TEST(RenderView, ATexelWithoutMaterialTakesNoPart) {
  Model model = model_of(square_mesh(), 2, 1, diffuse_brdf(0.4, 0.4, 0.4));
  model.material = {0, Model::kNoMaterial};
  const View view = view_from_above(40, 5.0);
  const ViewRenderer renderer(model);
  const RenderedView rendered = renderer.render(view, {});
  EXPECT_NEAR(rendered.radiance.at(5, 20), 0.4, kRounding);
  EXPECT_NEAR(rendered.radiance.at(29, 20), 0.4, kRounding) << "left of the empty texel's centre";
  EXPECT_EQ(rendered.radiance.at(31, 20), 0.0f) << "right of it nothing is known";
  EXPECT_EQ(rendered.hit[20 * 40 + 31], 1);
  const Image cluster = renderer.render_aov(view, Aov::Cluster);
  EXPECT_EQ(cluster.at(5, 20), 0.0f);
  EXPECT_EQ(cluster.at(31, 20), 65535.0f);
}

TEST(RenderView, EachStageShowsItsShareOfTheModel) {
  Model model = model_of(square_mesh(), 1, 1, diffuse_brdf(0.1, 0.1, 0.1));
  model.materials = {{diffuse_brdf(0.2, 0.2, 0.2), {diffuse_brdf(0.3, 0.3, 0.3), diffuse_brdf(0.7, 0.7, 0.7)}}};
  model.weights = Image(1, 1, 2);
  model.weights.data = {0.5f, 0.25f};
  const ViewRenderer renderer(model);
  const View view = view_from_above(4, 5.0);
  EXPECT_NEAR(renderer.render(view, {FitStage::Single, 1}).radiance.at(2, 2), 0.1, kRounding);
  EXPECT_NEAR(renderer.render(view, {FitStage::Cluster, 1}).radiance.at(2, 2), 0.2, kRounding);
  EXPECT_NEAR(renderer.render(view, {FitStage::Projection, 1}).radiance.at(2, 2), 0.15 + 0.175, kRounding);
  EXPECT_NEAR(renderer.render(view, {FitStage::Pfa, 1}).radiance.at(2, 2), 0.15 + 0.175, kRounding);  // none: as projected
}

TEST(RenderView, PrincipalFunctionsAndTheProjectionBeforeThemAreTwoStages) {
  Model model = model_of(square_mesh(), 1, 1, diffuse_brdf(0.1, 0.1, 0.1));
  model.materials = {{diffuse_brdf(0.2, 0.2, 0.2), {diffuse_brdf(0.3, 0.3, 0.3)}, {diffuse_brdf(0.6, 0.6, 0.6)}}};
  model.weights = Image(1, 1, 1, 0.5f);
  model.projection_weights = Image(1, 1, 1, 0.75f);
  const ViewRenderer renderer(model);
  const View view = view_from_above(4, 5.0);
  EXPECT_NEAR(renderer.render(view, {FitStage::Projection, 1}).radiance.at(2, 2), 0.45, kRounding);
  EXPECT_NEAR(renderer.render(view, {FitStage::Pfa, 1}).radiance.at(2, 2), 0.15, kRounding);
  EXPECT_NEAR(renderer.render(view, {}).radiance.at(2, 2), 0.15, kRounding) << "all that the model holds";
}

// The square is shifted so that it starts a given part into the first pixels, to the right and down.
TEST(RenderView, OneRayAsksThePixelsCentreMoreMeasureWhatItCovers) {
  const Model model = model_of(square_mesh(), 1, 1, diffuse_brdf(1, 1, 1));
  const ViewRenderer renderer(model);
  const auto radiance = [&](double shift_px, int rays, int x, int y) {
    View view = view_from_above(10, 5.0);
    view.camera.principal_x_px += shift_px;
    view.camera.principal_y_px += shift_px;
    return renderer.render(view, {FitStage::Projection, rays}).radiance.at(x, y);
  };
  EXPECT_NEAR(radiance(0.45, 1, 0, 0), 1.0, kRounding);
  EXPECT_EQ(radiance(0.55, 1, 0, 5), 0.0f);
  EXPECT_EQ(radiance(0.55, 1, 5, 0), 0.0f);
  EXPECT_NEAR(radiance(0.25, 16, 0, 5), 0.75, kRounding);
  EXPECT_NEAR(radiance(0.25, 16, 5, 0), 0.75, kRounding);
  EXPECT_NEAR(radiance(0.25, 16, 5, 5), 1.0, kRounding);
  EXPECT_BAD_INPUT(radiance(0.0, 0, 0, 0), "samples per pixel", "0");
}

TEST(RenderView, MapsOfTheModelAreSeenThroughTheCamera) {
  Model model = model_of(square_mesh(), 2, 1, diffuse_brdf(1, 1, 1));
  model.samples.data = {3.0f, 9.0f};
  model.uncertainty.data = {0.0f, 1.0f};
  const ViewRenderer renderer(model);
  View view = view_from_above(8, 5.0);
  view.camera.focal_x_px = view.camera.focal_y_px = 10.0;  // the square now fills the middle half
  const Image position = renderer.render_aov(view, Aov::Position);
  EXPECT_NEAR(position.at(4, 3, 0), 0.25, kRounding);
  EXPECT_NEAR(position.at(4, 3, 1), 0.25, kRounding);
  EXPECT_NEAR(position.at(4, 3, 2), 0.0, kRounding);
  const Image samples = renderer.render_aov(view, Aov::Samples), sigma = renderer.render_aov(view, Aov::Sigma);
  EXPECT_EQ(samples.at(3, 4), 3.0f);
  EXPECT_EQ(samples.at(4, 4), 9.0f);
  EXPECT_EQ(samples.at(0, 0), 0.0f);
  EXPECT_NEAR(sigma.at(4, 4), 0.75, kRounding);  // x = 0.25: a quarter of the way past the middle between the texels
  EXPECT_BAD_INPUT(renderer.render_aov(view, Aov::NormalSigma), "normal-sigma", "fitted normals");
  model.before_normals = ReflectanceLayer{};
  model.normal_sigma = Image(2, 1, 1);
  model.normal_sigma.data = {0.02f, 0.04f};
  EXPECT_NEAR(renderer.render_aov(view, Aov::NormalSigma).at(4, 4), 0.035, kRounding);
}

TEST(RenderView, ALightOfAnotherNumberOfChannelsIsRefused) {
  const Model model = model_of(square_mesh(), 1, 1, diffuse_brdf(1, 1, 1));
  View view = view_from_above(4, 5.0);
  view.light.intensity = {1.0};
  EXPECT_BAD_INPUT(ViewRenderer(model).render(view, {}), "above", "light", "1 channels");
}

TEST(RenderView, AFramingViewHoldsTheWholeMeshAndLightsIt) {
  Mesh mesh = sphere_mesh(40, 20);
  for (Eigen::Vector3d& position : mesh.positions) position = 0.01 * position + Eigen::Vector3d(3, 4, 5);
  const View view = framing_view(mesh, 3, 50, {1, -2, 1}, Eigen::Vector3d::UnitZ());
  for (const Eigen::Vector3d& position : mesh.positions) {
    const Eigen::Vector3d x_in_camera = view.camera_from_world * position;
    ASSERT_GT(x_in_camera.z(), 0.0);
    EXPECT_TRUE(view.camera.contains(view.camera.project(x_in_camera)));
  }
  const double up_px = view.camera.project(view.camera_from_world * Eigen::Vector3d(3, 4, 5.01)).y();
  EXPECT_LT(up_px, 25.0) << "up is up";
  const Model model = model_of(mesh, 1, 1, diffuse_brdf(1 / std::numbers::pi, 0, 0));
  const Eigen::Vector3d centre(3, 4, 5), facing = (view.camera_in_world() - centre).normalized();
  const Eigen::Vector3d to_light = view.light.vector_in_world - (centre + 0.01 * facing);
  const double nearer = (view.light.vector_in_world - centre).squaredNorm() / to_light.squaredNorm();
  const double expected = nearer * facing.dot(to_light.normalized());
  constexpr double kFacets = 0.01;  // 40 segments, and the pixel beside the middle
  EXPECT_NEAR(ViewRenderer(model).render(view, {}).radiance.at(25, 25, 0), expected, kFacets * expected);
}

}  // namespace
}  // namespace lumitexel
