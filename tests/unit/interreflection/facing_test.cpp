#include <gtest/gtest.h>

#include <algorithm>

#include "processing/interreflection/form_factors.h"
#include "processing/interreflection/indirect_bound.h"
#include "tests/unit/interreflection/bowl.h"

namespace lumitexel {
namespace {

std::vector<float> ones(const Mesh& mesh) { return std::vector<float>(mesh.triangles.size(), 1.0f); }

TEST(Facing, AConvexObjectFacesNothingOfItself) {
  const Mesh mesh = sphere_mesh(48, 24);
  for (const float share : facing(mesh, RayScene(mesh), ones(mesh))) EXPECT_EQ(share, 0.0f);
}

TEST(Facing, HalfOfWhatABowlFacesIsTheBowl) {
  const Mesh mesh = bowl_mesh();
  const std::vector<float> share = facing(mesh, RayScene(mesh), ones(mesh));
  double sum = 0.0, squares = 0.0, count = 0.0;
  for (std::size_t i = 0; i < share.size(); ++i) {
    if (mesh.positions[i].z() > -0.05) continue;  // the rim, and the half that is not there
    sum += share[i];
    squares += std::pow(static_cast<double>(share[i]) - 0.5, 2);
    count += 1.0;
  }
  EXPECT_NEAR(sum / count, 0.5, 0.005);
  EXPECT_LT(std::sqrt(squares / count), 0.04);  // 64 directions drawn evenly would scatter by 0.0625, stratified ones by less
}

TEST(Facing, WeightsCount) {
  const Mesh mesh = bowl_mesh();
  const std::vector<float> whole = facing(mesh, RayScene(mesh), ones(mesh));
  const std::vector<float> part = facing(mesh, RayScene(mesh), std::vector<float>(mesh.triangles.size(), 0.25f));
  for (std::size_t i = 0; i < whole.size(); ++i) EXPECT_FLOAT_EQ(part[i], 0.25f * whole[i]);
}

TEST(Facing, BacksAreBlack) {
  Mesh mesh = bowl_mesh();
  const std::vector<Eigen::Vector3d> normals = mesh.normals;
  for (auto& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);  // now all that faces the inside is backs
  for (const float share : facing(mesh, RayScene(mesh), ones(mesh))) EXPECT_EQ(share, 0.0f);
}

TEST(IndirectBound, IsAboveWhatComesAndNotFarAbove) {
  const double albedo = 0.7;
  const Model model = model_of(bowl_mesh(), 96, 48, diffuse_brdf(albedo / M_PI, 0.2 / M_PI, 0.1 / M_PI));
  const RayScene scene(model.mesh);
  const std::vector<float> albedos = triangle_albedos(model);
  EXPECT_NEAR(*std::max_element(albedos.begin(), albedos.end()), albedo, 0.01);
  // What comes: 0.27 of a lamp's light after any number of bounces. The bound has the whole bowl lit squarely, where that holds for its middle alone.
  for (const float bound : indirect_bounds(bowl_lumitexels(albedo, 1), model.mesh, scene, albedos)) {
    EXPECT_GT(bound, bowl_indirect_share(albedo, 50));
    EXPECT_LT(bound, 3.0 * bowl_indirect_share(albedo, 50));
  }
}

}  // namespace
}  // namespace lumitexel
