#include "processing/export/moved_model.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

Eigen::Vector3d normal_at(const Model& model, int x, int y) {
  return {model.normal.at(x, y, 0), model.normal.at(x, y, 1), model.normal.at(x, y, 2)};
}

// The sphere's normal, tilted a little, everywhere but in the first row.
Model tilted_sphere() {
  Model model = model_of(sphere_mesh(40, 20), 40, 20, diffuse_brdf(0.1, 0.1, 0.1));
  for (int y = 1; y < 20; ++y) {
    for (int x = 0; x < 40; ++x) {
      const double longitude = 2.0 * std::numbers::pi * (x + 0.5) / 40, latitude = std::numbers::pi * (0.5 - (y + 0.5) / 20);
      const Eigen::Vector3d smooth(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude));
      const Eigen::Vector3d tilted = (smooth + Eigen::Vector3d(0.1, -0.2, 0.15)).normalized();
      for (int k = 0; k < 3; ++k) model.normal.at(x, y, k) = static_cast<float>(tilted[k]);
    }
  }
  return model;
}

TEST(MovedModel, NormalsTurnWithTheMesh) {
  const Model model = tilted_sphere();
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  Mesh moved = model.mesh;
  moved.texcoords.clear();
  for (Eigen::Vector3d& position : moved.positions) position = turn * position + Eigen::Vector3d(0.1, 0.2, 0.3);
  for (Eigen::Vector3d& normal : moved.normals) normal = turn * normal;
  const Model there = on_moved_mesh(model, moved, "moved.ply");
  EXPECT_EQ(there.mesh.positions[7], moved.positions[7]);
  EXPECT_EQ(there.mesh.texcoords, model.mesh.texcoords);
  EXPECT_TRUE(normal_at(there, 3, 0).isZero()) << "the mesh's stays the mesh's";
  for (int y = 1; y < 20; ++y) {
    for (int x = 0; x < 40; ++x) EXPECT_LT((normal_at(there, x, y) - turn * normal_at(model, x, y)).norm(), 1e-5) << x << " " << y;
  }
}

TEST(MovedModel, WhereItDoesNotMoveNothingChanges) {
  const Model model = tilted_sphere();
  const Model there = on_moved_mesh(model, model.mesh, "same.ply");
  for (std::size_t i = 0; i < model.normal.data.size(); ++i) EXPECT_NEAR(there.normal.data[i], model.normal.data[i], 1e-6);
}

TEST(MovedModel, OtherTrianglesAreRefused) {
  const Model model = tilted_sphere();
  Mesh fewer = model.mesh, swapped = model.mesh;
  fewer.triangles.pop_back();
  std::swap(swapped.triangles[3], swapped.triangles[4]);
  EXPECT_BAD_INPUT(on_moved_mesh(model, fewer, "fewer.ply"), "fewer.ply", "the model's 861 vertices");
  EXPECT_BAD_INPUT(on_moved_mesh(model, swapped, "swapped.ply"), "swapped.ply: triangle 3", "in their order");
}

}  // namespace
}  // namespace lumitexel
