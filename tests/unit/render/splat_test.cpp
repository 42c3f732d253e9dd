#include "processing/render/splat.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "processing/evaluation/image_error.h"
#include "processing/model/render_view.h"
#include "processing/render/surface_points.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

constexpr double kRounding = 2e-6;

// A sphere of two mixed materials in waves as wide as 16 texels, one of them glossy, that holds a second, small one in
// its shadow.
Model two_spheres() {
  Mesh mesh = sphere_mesh(96, 48), small = sphere_mesh(48, 24);
  for (Eigen::Vector2d& uv : mesh.texcoords) uv.y() *= 0.75;
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  for (std::size_t v = 0; v < small.positions.size(); ++v) {
    mesh.positions.push_back(0.3 * small.positions[v] + Eigen::Vector3d(-0.4, 0.2, 1.5));
    mesh.normals.push_back(small.normals[v]);
    mesh.texcoords.emplace_back(small.texcoords[v].x(), 0.76 + 0.24 * small.texcoords[v].y());
  }
  for (const auto& t : small.triangles) mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  Brdf glossy;
  glossy.family = BrdfFamily::Ggx;
  glossy.diffuse = {0.02, 0.05, 0.1};
  glossy.lobes.resize(1);
  glossy.lobes[0].fill({std::log(0.3), std::log(0.4), kMirrorAim});
  Model model = model_of(std::move(mesh), 384, 256, glossy);
  model.materials[0].basis = {glossy, diffuse_brdf(0.25, 0.2, 0.1)};
  model.weights = Image(384, 256, 2);
  for (int y = 0; y < 256; ++y) {
    for (int x = 0; x < 384; ++x) {
      const double share =
          0.5 + 0.5 * std::sin(2 * std::numbers::pi * x / 16.0) * std::cos(2 * std::numbers::pi * y / 16.0);
      model.weights.at(x, y, 0) = static_cast<float>(share);
      model.weights.at(x, y, 1) = static_cast<float>(1.0 - share);
    }
  }
  return model;
}

View lit_view(int size_px) {
  View view = view_from_above(size_px, 6.0);
  view.camera.focal_x_px *= 0.8;
  view.camera.focal_y_px *= 0.8;
  view.light.type = Light::Type::Point;
  view.light.vector_in_world = {-3.0, 2.0, 6.0};
  view.light.intensity = {40.0, 40.0, 40.0};
  return view;
}

// Whether the object fills the pixel and its neighbours: at the outline the ray tracer mixes in the background.
bool inside(const RenderedView& rays, std::size_t p) {
  const auto width = static_cast<std::size_t>(rays.radiance.width), x = p % width, y = p / width;
  if (x == 0 || y == 0 || x + 1 == width || p + width + 1 >= rays.hit.size()) return false;
  for (const std::size_t row : {p - width, p, p + width}) {
    if (rays.hit[row - 1] == 0 || rays.hit[row] == 0 || rays.hit[row + 1] == 0) return false;
  }
  return true;
}

struct Comparison {
  double psnr_db = 0, seen_by_one = 0;
};

// PSNR over the pixels that both see whole; seen_by_one: over those that either sees.
Comparison compared(const SplatView& points, const RenderedView& rays) {
  std::vector<std::uint8_t> counted(rays.hit.size(), 0);
  double one = 0.0, either = 0.0;
  for (std::size_t p = 0; p < rays.hit.size(); ++p) {
    one += (rays.hit[p] != 0) != (points.hit[p] != 0);
    either += rays.hit[p] != 0 || points.hit[p] != 0;
    counted[p] = inside(rays, p) && points.hit[p] != 0;
  }
  ErrorSums sums;
  sums.add(points.radiance, rays.radiance, counted);
  return {sums.error().psnr_db, one / either};
}

TEST(Splat, ShowsWhatTheRayTracerShows) {
  const Model model = two_spheres();
  for (const int size_px : {64, 240}) {  // texels smaller than pixels, and larger
    const View view = lit_view(size_px);
    const Comparison result = compared(splat(model, view, {view.light}, FitStage::Pfa),
                                       ViewRenderer(model).render(view, {FitStage::Pfa, 64}));
    // 38.4 and 38.6 dB: what differs are the shadow's edges, blurred over a texel, and the waves, flattened a little by
    // the kernel.
    EXPECT_GT(result.psnr_db, 37.0) << size_px;
    EXPECT_LT(result.seen_by_one, 0.005) << "few centres at the outline";
  }
}

TEST(Splat, AFlatPlateIsEvenAndWithoutHolesAtAnyScale) {
  for (const int texels : {4, 32, 500}) {
    const Model model = model_of(square_mesh(), texels, texels, diffuse_brdf(0.1, 0.2, 0.3));
    const View view = view_from_above(100, 5.0);
    const SplatView points = splat(model, view, {view.light}, FitStage::Pfa);
    EXPECT_EQ(std::count(points.hit.begin(), points.hit.end(), 1), 100 * 100) << texels;
    for (std::size_t i = 0; i < points.radiance.data.size(); ++i) {
      ASSERT_NEAR(points.radiance.data[i], 0.1 * static_cast<double>(i % 3 + 1), kRounding) << texels << " " << i;
    }
    EXPECT_EQ(points.points, texels * texels);
    EXPECT_EQ(points.shown, points.points);
  }
}

// Nothing of a bright plate two spacings behind shines through, also seen aslant, where a pixel's depths spread. A lamp
// between the two lights it.
TEST(Splat, WhatIsHiddenDoesNotShineThrough) {
  Mesh mesh = square_mesh();
  constexpr int kTexels = 64;
  const double behind = 2.0 * 4.0 / kTexels;
  for (int v = 0; v < 4; ++v) mesh.texcoords[static_cast<std::size_t>(v)].x() *= 0.5;
  for (std::size_t v = 0; v < 4; ++v) {
    mesh.positions.push_back(mesh.positions[v] - behind * Eigen::Vector3d::UnitZ());
    mesh.normals.push_back(Eigen::Vector3d::UnitZ());
    mesh.texcoords.emplace_back(mesh.texcoords[v].x() + 0.5, mesh.texcoords[v].y());
  }
  mesh.triangles.insert(mesh.triangles.end(), {{4, 5, 6}, {4, 6, 7}});
  Model model = model_of(std::move(mesh), kTexels, kTexels, diffuse_brdf(0, 0, 0));
  model.materials.push_back({diffuse_brdf(1, 1, 1), {diffuse_brdf(1, 1, 1)}});
  for (std::size_t t = 0; t < model.material.size(); ++t) model.material[t] = t % kTexels >= kTexels / 2;
  for (const double slope : {0.0, 0.9}) {
    View view = view_from_above(80, 6.0);
    view.camera_from_world =
        view.camera_from_world * Eigen::Isometry3d(Eigen::AngleAxisd(slope, Eigen::Vector3d::UnitX()));
    view.light.type = Light::Type::Point;
    view.light.vector_in_world = {0.0, 0.0, -0.5 * behind};
    const RenderedView rays = ViewRenderer(model).render(view, {});
    const SplatView points = splat(model, view, {view.light}, FitStage::Pfa);
    const Image position = ViewRenderer(model).render_aov(view, Aov::Position);
    int compared_pixels = 0;
    for (int y = 0; y < 80; ++y) {
      for (int x = 0; x < 80; ++x) {
        const bool front = rays.hit[static_cast<std::size_t>(y * 80 + x)] != 0 && position.at(x, y, 2) > -0.5 * behind;
        const double margin = 4.0 / kTexels;  // the plate's edge is as sharp as its texels
        if (!front || std::abs(position.at(x, y, 0)) > 1 - 2 * margin ||
            std::abs(position.at(x, y, 1)) > 1 - 2 * margin)
          continue;
        ++compared_pixels;
        ASSERT_EQ(points.radiance.at(x, y), 0.0f) << slope << " " << x << " " << y;
      }
    }
    EXPECT_GT(compared_pixels, 2000);
  }
}

TEST(Splat, ATrianglesBackIsBlackAndHides) {
  Model model = model_of(square_mesh(), 16, 16, diffuse_brdf(0.5, 0.5, 0.5));
  for (auto& triangle : model.mesh.triangles) std::swap(triangle[1], triangle[2]);
  const View view = view_from_above(20, 5.0);
  const SplatView points = splat(model, view, {view.light}, FitStage::Pfa);
  EXPECT_EQ(points.radiance.at(10, 10), 0.0f);
  EXPECT_EQ(points.hit[210], 1);
  EXPECT_EQ(points.shown, 0);
}

// As triangles that no photograph saw: all corners at one texel.
TEST(Splat, TrianglesWithoutATexelOfTheirOwnAreCoveredToo) {
  Mesh mesh = sphere_mesh(24, 12);
  for (Eigen::Vector2d& uv : mesh.texcoords) uv = {0.5, 0.5};
  const Model model = model_of(std::move(mesh), 1, 1, diffuse_brdf(0.5, 0.5, 0.5));
  const View view = view_from_above(60, 5.0);
  const SplatView points = splat(model, view, {view.light}, FitStage::Pfa);
  const RenderedView rays = ViewRenderer(model).render(view, {});
  int holes = 0;
  for (std::size_t p = 0; p < rays.hit.size(); ++p) holes += rays.hit[p] != 0 && points.hit[p] == 0;
  EXPECT_EQ(holes, 0);
}

TEST(Splat, IsTheSameForAnyNumberOfThreadsAndRefusesStrangeLamps) {
  const Model model = two_spheres();
  const View view = lit_view(100);
  const auto run = [&](std::size_t threads) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    return splat(model, view, {view.light}, FitStage::Pfa);
  };
  const SplatView one = run(1), two = run(2), four = run(4);
  EXPECT_EQ(one.radiance.data, two.radiance.data);
  EXPECT_EQ(one.radiance.data, four.radiance.data);
  EXPECT_EQ(one.shown, four.shown);
  Light lamp;
  lamp.intensity = {1.0};
  EXPECT_BAD_INPUT(splat(model, view, {lamp}, FitStage::Pfa), "light", "1 channels");
}

TEST(SurfacePoints, LieAtTheirTexelsCentres) {
  const Model model = model_of(square_mesh(), 4, 2, diffuse_brdf(1, 1, 1));
  const std::vector<SurfacePoint> points = surface_points(model);
  ASSERT_EQ(points.size(), 8u);
  const SurfacePoint& point = points[6];  // second row, third texel
  EXPECT_EQ(point.x, 2);
  EXPECT_EQ(point.y, 1);
  EXPECT_LT((textured(model, point).position_in_world - Eigen::Vector3d(0.25, -0.5, 0.0)).norm(), 1e-12);
  EXPECT_LT((point.steps.col(0) - Eigen::Vector3d(0.5, 0, 0)).norm(), 1e-12);
  EXPECT_LT((point.steps.col(1) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12) << "down in the atlas is -y on the square";
}

}  // namespace
}  // namespace lumitexel
