#include "processing/render/carry_model.h"

#include <gtest/gtest.h>

#include <cmath>

#include "processing/model/render_view.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

// A sphere whose texels' own normals differ from its mesh's by a few degrees in a pattern; every other stripe has the
// mesh's.
Model bumpy_sphere() {
  Brdf glossy;
  glossy.family = BrdfFamily::Ward;
  glossy.diffuse = {0.2, 0.15, 0.1};
  glossy.lobes.resize(1);
  glossy.lobes[0].fill({std::log(0.3), std::log(0.3), kMirrorAim});
  Model model = model_of(sphere_mesh(48, 24), 64, 32, glossy);
  for (int y = 0; y < 32; ++y) {
    for (int x = 0; x < 64; ++x) {
      if (x / 4 % 2 == 1) continue;
      const double longitude = 2 * std::numbers::pi * (x + 0.5) / 64,
                   latitude = std::numbers::pi * (0.5 - (y + 0.5) / 32);
      const Eigen::Vector3d plain(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude),
                                  std::sin(latitude));
      const Eigen::Vector3d bumped =
          (plain + 0.1 * Eigen::Vector3d(std::sin(x), std::cos(y), std::sin(x + y))).normalized();
      for (int axis = 0; axis < 3; ++axis) model.normal.at(x, y, axis) = static_cast<float>(bumped[axis]);
    }
  }
  return model;
}

View point_lit_view() {
  View view = view_from_above(48, 4.0);
  view.camera.principal_x_px += 0.13;  // no ray through an edge of the mesh
  view.camera.principal_y_px += 0.29;
  view.light.type = Light::Type::Point;
  view.light.vector_in_world = {2.0, 1.0, 3.0};
  view.light.intensity = {9.0, 9.0, 9.0};
  return view;
}

void moved_by(Mesh& mesh, const Eigen::Isometry3d& motion) {
  for (Eigen::Vector3d& position : mesh.positions) position = motion * position;
  for (Eigen::Vector3d& normal : mesh.normals) normal = motion.linear() * normal;
}

TEST(CarryModel, MeshCameraAndLightMovedTogetherGiveTheSamePicture) {
  const Model model = bumpy_sphere();
  const View view = point_lit_view();
  Eigen::Isometry3d motion = Eigen::Isometry3d::Identity();
  motion.linear() = Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  motion.translation() = Eigen::Vector3d(0.5, -2.0, 1.0);
  Mesh mesh = model.mesh;
  moved_by(mesh, motion);
  const Model carried = carried_to(model, mesh, "moved");
  View followed = view;
  followed.camera_from_world = view.camera_from_world * motion.inverse();
  followed.light.vector_in_world = motion * view.light.vector_in_world;
  const RenderedView before = ViewRenderer(model).render(view, {}), after = ViewRenderer(carried).render(followed, {});
  int lit = 0, apart = 0;
  for (std::size_t i = 0; i < before.radiance.data.size(); ++i) {
    // Rays in single precision meet the sphere elsewhere by 1e-7 of its size; at outline and shadow they may decide
    // otherwise.
    lit += before.radiance.data[i] > 0.1f;
    apart += std::abs(before.radiance.data[i] - after.radiance.data[i]) > 1e-4f * (1.0f + before.radiance.data[i]);
  }
  EXPECT_GT(lit, 1500);
  EXPECT_LE(apart, 6) << "two pixels of three channels";
}

TEST(CarryModel, ReliefIsDrawnOutWhereItsTriangleIsAndKeptWhereItIsScaled) {
  Model model = model_of(square_mesh(), 4, 4, diffuse_brdf(1, 1, 1));
  const Eigen::Vector3f tilted(0.6f, 0.0f, 0.8f);
  for (std::size_t t = 0; t < 16; ++t) std::copy(tilted.data(), tilted.data() + 3, &model.normal.data[3 * t]);
  const auto normal_after = [&](const Eigen::Vector3d& stretch) {
    Mesh mesh = model.mesh;
    for (Eigen::Vector3d& position : mesh.positions) position = position.cwiseProduct(stretch);
    const Model carried = carried_to(model, mesh, "stretched");
    return Eigen::Vector3d(carried.normal.at(1, 2, 0), carried.normal.at(1, 2, 1), carried.normal.at(1, 2, 2));
  };
  constexpr double kFloat = 1e-6;
  EXPECT_LT((normal_after({3, 3, 3}) - tilted.cast<double>()).norm(), kFloat);
  // Twice as long in x: the slope dz/dx = -0.6 / 0.8 becomes that over 2, times the height's sqrt(2).
  const Eigen::Vector3d expected = Eigen::Vector3d(0.6 / 2.0, 0.0, 0.8 / std::sqrt(2.0)).normalized();
  EXPECT_LT((normal_after({2, 1, 1}) - expected).norm(), kFloat);
}

// The scan a model was fitted on is not split at the atlas's seams.
TEST(CarryModel, TheChangedMeshMayBeSplitOtherwise) {
  const Model model = bumpy_sphere();  // seam and poles are split
  Mesh welded = model.mesh;
  const auto original = [&](std::uint32_t vertex) {
    for (std::uint32_t v = 0; v < vertex; ++v) {
      if ((model.mesh.positions[v] - model.mesh.positions[vertex]).norm() < 1e-9) return v;
    }
    return vertex;
  };
  for (auto& triangle : welded.triangles) {
    for (std::uint32_t& vertex : triangle) vertex = original(vertex);
  }
  welded.texcoords.clear();
  const Model carried = carried_to(model, welded, "welded");
  EXPECT_EQ(carried.mesh.texcoords, model.mesh.texcoords);
  for (std::size_t v = 0; v < model.mesh.positions.size(); ++v) {
    ASSERT_LT((carried.mesh.positions[v] - model.mesh.positions[v]).norm(), 1e-9);
  }
  for (std::size_t i = 0; i < model.normal.data.size(); ++i)
    ASSERT_NEAR(carried.normal.data[i], model.normal.data[i], 1e-5);
}

TEST(CarryModel, AVertexThatIsSplitInTheChangedMeshTakesTheMeanNormal) {
  const Model model = model_of(square_mesh(), 1, 1, diffuse_brdf(1, 1, 1));
  Mesh split = model.mesh;
  split.positions.push_back(split.positions[2]);
  split.normals.push_back(Eigen::Vector3d::UnitX());
  split.triangles[1][1] = 4;  // was 2, which the first triangle keeps
  const Mesh carried = carried_to(model, split, "split").mesh;
  EXPECT_LT((carried.normals[2] - Eigen::Vector3d(1, 0, 1).normalized()).norm(), 1e-12);
  EXPECT_EQ(carried.normals[0], Eigen::Vector3d(Eigen::Vector3d::UnitZ()));
}

TEST(CarryModel, WhatStaysWhereItIsKeepsItsBits) {
  const Model model = bumpy_sphere();
  const Model carried = carried_to(model, model.mesh, "the same");
  EXPECT_EQ(carried.normal.data, model.normal.data);
  EXPECT_EQ(carried.mesh.normals, model.mesh.normals);
}

TEST(CarryModel, RefusesAnotherTopologyByName) {
  const Model model = bumpy_sphere();
  Mesh fewer = model.mesh;
  fewer.triangles.pop_back();
  EXPECT_BAD_INPUT(carried_to(model, fewer, "pose.ply"), "pose.ply", "2207 triangles", "2208");
  Mesh shuffled = model.mesh;
  std::swap(shuffled.triangles[500], shuffled.triangles[900]);
  EXPECT_BAD_INPUT(carried_to(model, shuffled, "pose.ply"), "pose.ply", "triangle 500", "same order");
  Mesh turned = model.mesh;
  std::rotate(turned.triangles[700].begin(), turned.triangles[700].begin() + 1, turned.triangles[700].end());
  EXPECT_BAD_INPUT(carried_to(model, turned, "pose.ply"), "pose.ply", "triangle 700");
  Model plate = model_of(square_mesh(), 1, 1, diffuse_brdf(1, 1, 1));
  Mesh flat = plate.mesh;
  for (Eigen::Vector3d& position : flat.positions) position.y() = 0.0;
  EXPECT_BAD_INPUT(carried_to(plate, flat, "pose.ply"), "pose.ply", "triangle 0", "no area");
}

}  // namespace
}  // namespace lumitexel
