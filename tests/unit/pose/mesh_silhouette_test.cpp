#include "processing/calibration/pose/mesh_silhouette.h"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/error.h"
#include "processing/calibration/pose/silhouette_equations.h"
#include "sim/cube_sphere.h"
#include "sim/procedural_object.h"
#include "tests/unit/pose/backlit_view.h"

namespace lumitexel {
namespace {

Mesh ball(double radius_m, const Eigen::Vector3d& centre) {
  Mesh mesh = cube_sphere(12);
  for (Eigen::Vector3d& x : mesh.positions) x = centre + radius_m * x.normalized();
  mesh.normals = vertex_normals(mesh);
  return mesh;
}

// Angle between a pixel's ray and the cone that touches the ball, in pixels.
double off_cone_px(const CameraModel& camera, const Eigen::Vector2d& pixel, const Eigen::Vector3d& centre, double radius_m) {
  const double angle = std::acos(camera.unproject(pixel).dot(centre.normalized()));
  return (angle - std::asin(radius_m / centre.norm())) * camera.focal_x_px;
}

TEST(MeshSilhouette, ASmoothBallsRimIsTheBallsAndNotItsFacets) {
  const CameraModel camera = bench_camera(0.25);
  const MeshSilhouette mesh(ball(0.08, Eigen::Vector3d::Zero()));
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.02, -0.01, 1.0);
  const CentredPose centred(pose, mesh.extent().centre);
  const auto worst_and_length = [&](RimModel model) {
    double worst = 0.0, length = 0.0;
    for (const RimPoint& rim : mesh.outline(camera, centred, 2.0, model)) {
      worst = std::max(worst, std::abs(off_cone_px(camera, rim.pixel, pose.translation(), 0.08)));
      length += rim.length_px;
    }
    return std::pair(worst, length);
  };
  const auto [smooth, smooth_length] = worst_and_length(RimModel::Smooth);
  const auto [facets, facets_length] = worst_and_length(RimModel::Facets);
  const double perimeter = 2.0 * M_PI * camera.focal_x_px * std::tan(std::asin(0.08));
  EXPECT_LT(smooth, 0.06);  // 48 facets around: the patch is a cubic, its error some 1e-2 of the chord's
  EXPECT_GT(facets, 0.3);   // the chord's: 236 px * (1 - cos(3.75 degrees)) = 0.5 px
  EXPECT_NEAR(smooth_length, perimeter, 0.05 * perimeter);
  EXPECT_NEAR(facets_length, perimeter, 0.05 * perimeter);
}

TEST(MeshSilhouette, OnlyTheOuterContour) {
  Mesh two = ball(0.05, {0.0, 0.0, 0.0});
  const Mesh behind = ball(0.02, {0.0, 0.0, 0.3});  // in the other's shadow
  const auto offset = static_cast<std::uint32_t>(two.positions.size());
  two.positions.insert(two.positions.end(), behind.positions.begin(), behind.positions.end());
  for (auto t : behind.triangles) two.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  const MeshSilhouette mesh(two);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = Eigen::Vector3d(0.0, 0.0, 1.0);
  const CameraModel camera = bench_camera(0.25);
  for (const RimPoint& rim : mesh.outline(camera, CentredPose(pose, mesh.extent().centre), 2.0, RimModel::Smooth)) {
    EXPECT_LT(std::abs(off_cone_px(camera, rim.pixel, pose.translation(), 0.05)), 1.0);
  }
}

TEST(MeshSilhouette, DerivativesAreTheDistances) {
  // A rim's contour moves as the derivative of the fixed surface point says, to first order.
  const CameraModel camera = bench_camera(0.25);
  const Mesh object = vase_scan({0.16, {0, 0, 0}, 1e-4, 1});
  const MeshSilhouette mesh(object);
  const CentredPose pose(bench_camera_from_table(), mesh.extent().centre);
  SilhouetteContour drawn{camera.width_px, camera.height_px, {}, 0.0};
  for (const RimPoint& rim : mesh.outline(camera, pose, 0.2, RimModel::Smooth)) drawn.points.push_back({rim.pixel, rim.normal, 0.1});
  const ContourLookup lookup(drawn);
  for (Eigen::Index k = 0; k < 6; ++k) {
    PoseStep step = PoseStep::Zero();
    step[k] = k < 3 ? 0.002 : 0.0002;  // some half of a pixel; depth: less
    std::vector<double> off;
    for (const SilhouetteEquation& row :
         silhouette_equations(mesh, lookup, camera, pose.moved(step), 4.0, 2.0, RimModel::Smooth).rows) {
      off.push_back(std::abs(row.distance_px + row.by_pose * step));
    }
    ASSERT_GT(off.size(), 100u);
    std::nth_element(off.begin(), off.begin() + static_cast<std::ptrdiff_t>(off.size() / 2), off.end());
    EXPECT_LT(off[off.size() / 2], 0.03) << k;  // second order: (0.5 px)^2 over a radius of tens of pixels
  }
}

TEST(MeshSilhouette, ProjectionDerivatives) {
  const CameraModel camera = bench_camera(0.25);
  const Eigen::Vector3d x(0.11, -0.07, 0.9);
  const ProjectedPoint p = project_with_derivatives(camera, x);
  EXPECT_LT((p.pixel - camera.project(x)).norm(), 1e-9);
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Eigen::Vector3d h = 1e-6 * Eigen::Vector3d::Unit(k);
    const Eigen::Vector2d slope = (camera.project(x + h) - camera.project(x - h)) / 2e-6;
    EXPECT_LT((slope - p.by_point.col(k)).norm(), 1e-4 * (1.0 + slope.norm()));
  }
  for (Eigen::Index k = 0; k < 8; ++k) {
    const LensVector h = 1e-4 * LensVector::Unit(k);
    const Eigen::Vector2d slope = (with_lens_vector(camera, lens_vector(camera) + h).project(x) - with_lens_vector(camera, lens_vector(camera) - h).project(x)) / 2e-4;
    EXPECT_LT((slope - p.by_lens.col(k)).norm(), 1e-4 * (1.0 + slope.norm())) << k;
  }
}

TEST(MeshSilhouette, AnEmptyMeshIsBadInput) { EXPECT_THROW(MeshSilhouette{Mesh{}}, BadInput); }

}  // namespace
}  // namespace lumitexel
