// What rays hit must not depend on the processor that traces them.
#include "processing/surface/ray_scene.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <random>

#include "processing/brdf/evaluate_packed.h"
#include "tests/unit/sphere_session.h"

namespace lumitexel {
namespace {

constexpr int kRays = 100'000;
constexpr double kRounding = 1e-5;  // of floats, in which rays are traced: a hundred roundings

// A sphere and a smaller one beside it, half sunk into it, so that there are shadows and creases.
Mesh two_spheres() {
  Mesh mesh = sphere_mesh(0.1, 40);
  const Mesh small = sphere_mesh(0.05, 25);
  const auto before = static_cast<std::uint32_t>(mesh.positions.size());
  for (const Eigen::Vector3d& position : small.positions) mesh.positions.push_back(position + Eigen::Vector3d(0.1, 0.02, 0.03));
  mesh.normals.insert(mesh.normals.end(), small.normals.begin(), small.normals.end());
  for (const auto& triangle : small.triangles) mesh.triangles.push_back({triangle[0] + before, triangle[1] + before, triangle[2] + before});
  return mesh;
}

Eigen::Vector3d any_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
}

struct Compared {
  int hits = 0, other_triangles = 0, shadows = 0, other_shadows = 0;
  double most_of_weights = 0, most_of_distance = 0;  // the second relative

  void see(const std::optional<RayHit>& a, const std::optional<RayHit>& b) {
    hits += a.has_value();
    other_triangles += a.has_value() != b.has_value() || (a && b && a->triangle != b->triangle);
    if (!a || !b || a->triangle != b->triangle) return;
    most_of_weights = std::max({most_of_weights, std::abs(a->u - b->u), std::abs(a->v - b->v)});
    most_of_distance = std::max(most_of_distance, std::abs(a->distance_m / b->distance_m - 1.0));
  }
};

// From half a metre away towards the object, and from what is hit to a lamp.
Compared compared(const RayScene& one, const RayScene& other) {
  std::mt19937 random(1);
  const Eigen::Vector3d lamp(0.6, 0.5, 0.4);
  Compared result;
  for (int ray = 0; ray < kRays; ++ray) {
    const Eigen::Vector3d eye = 0.5 * any_direction(random), toward = (0.15 * any_direction(random) - eye).normalized();
    const std::optional<RayHit> hit = one.closest(eye, toward);
    result.see(hit, other.closest(eye, toward));
    if (!hit) continue;
    const Eigen::Vector3d point = eye + hit->distance_m * toward, up = (lamp - point).normalized();
    const bool shadow = one.occluded(point, up, one.surface_offset_m(), (lamp - point).norm());
    result.shadows += shadow;
    result.other_shadows += shadow != other.occluded(point, up, one.surface_offset_m(), (lamp - point).norm());
  }
  return result;
}

TEST(RayScene, HitsTheSameOnAvx2AndAvx512) {
  if (widest_vectors() < VectorWidth::Avx512) GTEST_SKIP() << "SKIPPED: this processor has no AVX-512 to compare AVX2 with";
  const Mesh mesh = two_spheres();
  const Compared found = compared(RayScene(mesh, "avx2"), RayScene(mesh, "avx512"));
  std::printf("%d hits, %d shadows; largest difference of weights %.3g, of distance %.3g\n", found.hits, found.shadows, found.most_of_weights,
              found.most_of_distance);
  EXPECT_GT(found.hits, kRays / 4);
  EXPECT_GT(found.shadows, kRays / 50);
  EXPECT_EQ(found.other_triangles, 0);
  EXPECT_EQ(found.other_shadows, 0);
  EXPECT_LT(found.most_of_weights, kRounding);
  EXPECT_LT(found.most_of_distance, kRounding);
}

}  // namespace
}  // namespace lumitexel
