#include "processing/calibration/pose/register_view.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "drivers/error.h"
#include "sim/cube_sphere.h"
#include "sim/procedural_object.h"
#include "tests/unit/pose/backlit_view.h"

namespace lumitexel {
namespace {

Mesh transformed(Mesh mesh, double scale, const Eigen::Vector3d& shift) {
  for (Eigen::Vector3d& x : mesh.positions) x = scale * x + shift;
  mesh.normals = vertex_normals(mesh);
  return mesh;
}

// A lump without any symmetry.
Mesh lump() {
  Mesh mesh = cube_sphere(24);
  for (Eigen::Vector3d& x : mesh.positions) {
    const Eigen::Vector3d d = x.normalized();
    const double r = 1.0 + 0.25 * std::sin(2.0 * d.x() + 3.0 * d.y()) + 0.2 * std::cos(3.0 * d.z() - 2.0 * d.x()) + 0.15 * d.y() * d.z();
    x = 0.06 * r * Eigen::Vector3d(1.2 * d.x(), 0.8 * d.y(), d.z());
  }
  mesh.normals = vertex_normals(mesh);
  return mesh;
}

Mesh cube() {
  Mesh mesh;
  for (int k = 0; k < 8; ++k) mesh.positions.push_back(0.05 * Eigen::Vector3d(k & 1 ? 1 : -1, k & 2 ? 1 : -1, k & 4 ? 1 : -1));
  mesh.triangles = {{0, 2, 3}, {0, 3, 1}, {4, 5, 7}, {4, 7, 6}, {0, 1, 5}, {0, 5, 4},
                    {2, 6, 7}, {2, 7, 3}, {0, 4, 6}, {0, 6, 2}, {1, 3, 7}, {1, 7, 5}};
  mesh.normals = vertex_normals(mesh);
  return mesh;
}

struct Seen {
  Mesh mesh;
  CameraModel camera = bench_camera(0.25);
  Eigen::Isometry3d truth = bench_camera_from_table();
  double panel_e = 10000.0;
  std::vector<DarkDisc> discs{};
};

ViewRegistration register_seen(const Seen& seen, const Eigen::Isometry3d& start, const ViewRegistrationOptions& options,
                               std::uint64_t seed = 1) {
  const RayScene rays(seen.mesh);
  const MosaicRadiance picture = backlit_view({seen.mesh, rays, seen.camera, seen.truth, seen.discs, seen.panel_e, 4.0, 8}, seed);
  return register_view(MeshSilhouette(seen.mesh), ContourLookup(silhouette_contour(picture)), seen.camera, start, options);
}

ViewRegistrationOptions near_only() {
  ViewRegistrationOptions options;
  options.search = {0.0, 0.0};
  options.other_rotations = false;
  return options;
}

// At 1 Mpixel a pixel is four of the 12 Mpixel for which 0.1 mm and 0.02 degrees are the goal. Distance is taken apart: it
// is seen through the outline's size alone, ten times weaker.
constexpr double kAcross_m = 1e-4, kAlong_m = 1e-3, kTurn_deg = 0.08;

void expect_found(const ViewRegistration& found, const Seen& seen) {
  ASSERT_TRUE(found.converged) << found.problem;
  const PoseError error = pose_error(found.camera_from_mesh, seen.truth, seen.mesh);
  EXPECT_LT(error.step.segment<2>(3).norm(), kAcross_m);
  EXPECT_LT(std::abs(error.step[5]), kAlong_m);
  EXPECT_LT(error.turn_deg, kTurn_deg);
  EXPECT_LT(found.silhouette_px, 0.25);
}

TEST(RegisterView, FindsTheObjectFromAFarStartAmongOtherDarkThings) {
  Seen seen{lump()};
  for (int k = 0; k < 6; ++k) seen.discs.push_back({Eigen::Vector2d(100 + 165 * k, 45), 55});
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (int trial = 0; trial < 3; ++trial) {
    const Eigen::Vector3d turn(normal(random), normal(random), normal(random)), shift(normal(random), normal(random), normal(random));
    const Eigen::Isometry3d start = disturbed(seen.truth, seen.mesh, 18.0 * turn.normalized(), 0.09 * shift.normalized());
    ViewRegistrationOptions options;
    options.other_rotations = trial == 0;
    const ViewRegistration found = register_seen(seen, start, options, static_cast<std::uint64_t>(trial));
    expect_found(found, seen);
    EXPECT_FALSE(found.ambiguous());
  }
}

TEST(RegisterView, AKilometreFromTheOriginLosesNothing) {
  const Seen here{lump()};
  Seen there = here;
  const Eigen::Vector3d offset(1000.0, -700.0, 300.0);
  there.mesh = transformed(there.mesh, 1.0, offset);
  there.truth = here.truth * Eigen::Translation3d(-offset);
  const auto error_of = [](const Seen& seen) {
    const auto found = register_seen(seen, disturbed(seen.truth, seen.mesh, {0.3, 0.2, -0.3}, {1e-3, 0, 2e-3}), near_only());
    return pose_error(found.camera_from_mesh, seen.truth, seen.mesh).step;
  };
  // The same picture but for rounding of coordinates to 1e-13 m; pixels whose sampling is decided by that are few.
  EXPECT_LT((error_of(here) - error_of(there)).cwiseAbs().maxCoeff(), 2e-5);
}

TEST(RegisterView, ShortAndLongLensesSmallAndLargeObjects) {
  struct Extreme { double focal_mm, scale, distance_m; };
  // A sensor 35 mm wide; the object of some 14 cm scaled to 1 cm and 3 m.
  for (const Extreme& e : {Extreme{15, 1.0, 0.14}, Extreme{300, 1.0, 3.0}, Extreme{60, 0.07, 0.05}, Extreme{50, 21.0, 9.0}}) {
    Seen seen{transformed(lump(), e.scale, Eigen::Vector3d::Zero())};
    const double focal = e.focal_mm / 35.0 * 1024;
    seen.camera = {1024, 768, focal, focal, 512, 384, 0, 0, 0, 0};
    seen.truth.linear() = bench_camera_from_table().linear();
    seen.truth.translation() = Eigen::Vector3d(0, 0, e.distance_m);
    const auto start = disturbed(seen.truth, seen.mesh, {1.0, -1.0, 1.0}, e.distance_m * Eigen::Vector3d(5e-3, 0, 5e-3));
    const ViewRegistration found = register_seen(seen, start, near_only());
    ASSERT_TRUE(found.converged) << e.focal_mm << " mm: " << found.problem;
    const PoseError error = pose_error(found.camera_from_mesh, seen.truth, seen.mesh);
    EXPECT_LT(found.silhouette_px, 0.25) << e.focal_mm;
    EXPECT_LT(error.turn_deg, std::max(0.08, 5.0 * found.sigma_deg)) << e.focal_mm;
    EXPECT_LT(error.shift_m, 5.0 * found.sigma_m) << e.focal_mm;
    EXPECT_LT(found.sigma_m, 5e-3 * e.distance_m) << e.focal_mm;
  }
}

TEST(RegisterView, StatedSigmaHolds) {
  Seen seen{lump()};
  seen.panel_e = 300.0;  // noise well above the facets' and the lookup's own errors
  const RayScene rays(seen.mesh);
  const MeshSilhouette mesh(seen.mesh);
  constexpr int kSeeds = 16;
  ViewRegistrationOptions options = near_only();
  options.model = RimModel::Facets;
  Eigen::Matrix<double, 6, 1> chi_sq = Eigen::Matrix<double, 6, 1>::Zero();
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const MosaicRadiance picture = backlit_view({seen.mesh, rays, seen.camera, seen.truth, {}, seen.panel_e, 4.0, 4}, seed);
    const auto start = disturbed(seen.truth, seen.mesh, {0.1, 0.1, 0.1}, {1e-4, 1e-4, 1e-4});
    const ViewRegistration found = register_view(mesh, ContourLookup(silhouette_contour(picture)), seen.camera, start, options);
    chi_sq += pose_error(found.camera_from_mesh, seen.truth, seen.mesh).step.cwiseAbs2().cwiseQuotient(found.covariance.diagonal());
  }
  // 16 draws tell a ratio to 18 %; two of its standard deviations above 1. Below: kSharedError_px, common to all draws, is
  // in what is stated, and for distance the mesh's possible thickness, which an exact mesh does not have.
  for (Eigen::Index k = 0; k < 6; ++k) {
    EXPECT_LT(std::sqrt(chi_sq[k] / kSeeds), 1.36) << k;
    if (k < 5) { EXPECT_GT(std::sqrt(chi_sq[k] / kSeeds), 0.08) << k; }
  }
}

TEST(RegisterView, ASurfaceOfRevolutionIsAmbiguousAboutItsAxis) {
  Mesh spindle = cube_sphere(32);
  for (Eigen::Vector3d& x : spindle.positions) {
    const Eigen::Vector3d d = x.normalized();
    x = 0.06 * Eigen::Vector3d(d.x(), d.y(), 1.3 * d.z()) * (1.0 + 0.15 * std::sin(3.0 * d.z()));
  }
  const Seen seen{spindle};
  const ViewRegistration found = register_seen(seen, disturbed(seen.truth, seen.mesh, {1, 1, 0}, {2e-3, 0, 2e-3}), near_only());
  ASSERT_EQ(found.ambiguities.size(), 1u);
  EXPECT_EQ(found.ambiguities[0].angle_deg, 0.0);
  EXPECT_GT(std::abs(found.ambiguities[0].axis_in_mesh.z()), 0.99);
}

TEST(RegisterView, ABallIsAmbiguousAboutEveryAxis) {
  Mesh ball = cube_sphere(24);
  for (Eigen::Vector3d& x : ball.positions) x = 0.06 * x.normalized();
  const Seen seen{ball};
  EXPECT_EQ(register_seen(seen, disturbed(seen.truth, seen.mesh, {2, 1, 0}, {2e-3, 0, 2e-3}), near_only()).ambiguities.size(), 3u);
}

TEST(RegisterView, ACubeIsAmbiguousByQuarterTurns) {
  const Seen seen{cube()};
  ViewRegistrationOptions options = near_only();
  options.other_rotations = true;
  const ViewRegistration found = register_seen(seen, disturbed(seen.truth, seen.mesh, {2, 1, 0}, {2e-3, 0, 2e-3}), options);
  EXPECT_TRUE(found.converged) << found.problem;
  // 23 other rotations map a cube onto itself. Not all need be found for the pose to be called ambiguous; those that are
  // must be of the group: 90, 120 or 180 degrees.
  EXPECT_GE(found.ambiguities.size(), 3u);
  for (const PoseAmbiguity& other : found.ambiguities) {
    const double off = std::min({std::abs(other.angle_deg - 90), std::abs(other.angle_deg - 120), std::abs(other.angle_deg - 180)});
    EXPECT_LT(off, 1.0) << other.angle_deg;
  }
}

TEST(RegisterView, WhatCannotBeFoundIsSaid) {
  const Seen seen{lump()};
  const MeshSilhouette mesh(seen.mesh);
  const ContourLookup empty(SilhouetteContour{1024, 768, {}, 0.0});
  const ViewRegistration found = register_view(mesh, empty, seen.camera, seen.truth, {});
  EXPECT_FALSE(found.converged);
  EXPECT_FALSE(found.problem.empty());
  Eigen::Isometry3d behind = seen.truth;
  behind.translation().z() = -1.0;
  EXPECT_THROW(register_view(mesh, empty, seen.camera, behind, {}), BadInput);
  Eigen::Isometry3d broken = seen.truth;
  broken.translation().x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(register_view(mesh, empty, seen.camera, broken, {}), BadInput);
}

}  // namespace
}  // namespace lumitexel
