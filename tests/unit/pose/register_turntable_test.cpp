#include "processing/calibration/pose/register_turntable.h"

#include <gtest/gtest.h>

#include <cmath>
#include <list>
#include <numbers>
#include <random>

#include "drivers/error.h"
#include "processing/calibration/pose/joint_refinement.h"
#include "sim/procedural_object.h"
#include "tests/unit/pose/backlit_view.h"

namespace lumitexel {
namespace {

constexpr int kViews = 6;

// The vase turning on a table whose axis is not where the description has it.
struct Bench {
  Mesh mesh = vase_scan({0.16, {0.0, 0.0, -0.008}, 1e-4, 1});
  MeshSilhouette silhouette{mesh};
  CameraModel camera = bench_camera(0.25);
  Eigen::Isometry3d camera_from_table = bench_camera_from_table();
  Eigen::Isometry3d table_from_mesh = Eigen::Isometry3d::Identity();
  Eigen::Vector3d axis = Eigen::Vector3d(0.002, -0.003, 1.0).normalized(), point{0.0008, -0.0005, 0.0};
  std::list<ContourLookup> lookups;
  std::vector<TurntableView> views;
  std::vector<TagDescription> tags;

  Bench() {
    table_from_mesh.linear() = Eigen::AngleAxisd(0.01, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    table_from_mesh.translation() = Eigen::Vector3d(0.002, -0.001, 0.001);
    const RayScene rays(mesh);
    for (int v = 0; v < kViews; ++v) {
      views.push_back({nullptr, 60.0 * v});
      const MosaicRadiance picture = backlit_view({mesh, rays, camera, truth(v), {}, 10000.0, 4.0, 4}, static_cast<std::uint64_t>(v));
      lookups.emplace_back(silhouette_contour(picture));
      views.back().contour = &lookups.back();
    }
    for (int id = 0; id < 8; ++id) {
      const double a = id * std::numbers::pi / 4.0;
      tags.push_back({id, 0.015, true, {0.1 * std::cos(a), 0.1 * std::sin(a), -0.09}, Eigen::Vector3d::UnitZ(), Eigen::Vector3d::UnitY()});
    }
  }
  Eigen::Isometry3d camera_from_table_at(int v) const {
    return camera_from_table * Eigen::Translation3d(point) * Eigen::AngleAxisd(60.0 * v * std::numbers::pi / 180.0, axis) * Eigen::Translation3d(-point);
  }
  Eigen::Isometry3d truth(int v) const { return camera_from_table_at(v) * table_from_mesh; }

  std::vector<TagObservation> observed(double sigma_px, std::uint64_t seed) const {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, sigma_px);
    std::vector<TagObservation> all;
    for (int v = 0; v < kViews; ++v) {
      for (const TagDescription& tag : tags) {
        TagObservation seen{tag.id, static_cast<std::size_t>(v), {}, sigma_px};
        for (std::size_t k = 0; k < 4; ++k) {
          seen.corners_px[k] = camera.project(camera_from_table_at(v) * tag.corners()[k]) + Eigen::Vector2d(normal(random), normal(random));
        }
        all.push_back(seen);
      }
    }
    return all;
  }
  // What the rig's description would say.
  TurntableStart start() const {
    TurntableStart s;
    s.camera = camera;
    s.camera_from_table = camera_from_table;
    return s;
  }
};

const Bench& bench() {
  static const Bench b;
  return b;
}

TurntableOptions near_only() {
  TurntableOptions options;
  options.search = {0.0, 0.0};
  options.rim_points = 3000;
  return options;
}

// At 1 Mpixel, across the view; distance is ten times weaker (see register_view_test.cpp).
void expect_views_found(const TurntableRegistration& found, double across_m, double along_m, double turn_deg) {
  ASSERT_TRUE(found.converged) << found.problem;
  ASSERT_EQ(found.views.size(), static_cast<std::size_t>(kViews));
  for (int v = 0; v < kViews; ++v) {
    const RegisteredView& view = found.views[static_cast<std::size_t>(v)];
    const PoseError error = pose_error(view.camera_from_mesh, bench().truth(v), bench().mesh);
    EXPECT_LT(error.step.segment<2>(3).norm(), across_m) << v;
    EXPECT_LT(std::abs(error.step[5]), along_m) << v;
    EXPECT_LT(error.turn_deg, turn_deg) << v;
    EXPECT_LT(view.silhouette_px, 0.25) << v;
    EXPECT_NEAR(view.shares.contour + view.shares.tags + view.shares.lens + view.shares.angles + view.shares.mesh, 1.0, 1e-6);
  }
}

TEST(RegisterTurntable, DerivativesOfEveryViewByEveryUnknown) {
  TurntableModel model;
  model.camera_from_mesh = CentredPose(bench_camera_from_table(), {0.01, 0.02, -0.01});
  model.axis_in_mesh = Eigen::Vector3d(0.1, -0.2, 1.0).normalized();
  model.axis_point_in_mesh = {0.03, 0.01, 0.0};
  model.camera = bench_camera(0.25);
  model.angle_offset_rad = {0.0, 0.01};
  const TurntableUnknowns unknowns(true, true, true, 2);
  const double angle = 1.1;
  const Eigen::MatrixXd d = view_derivatives(model, unknowns, 1, angle + model.angle_offset_rad[1]);
  const CentredPose here = pose_at(model, angle + model.angle_offset_rad[1]);
  for (Eigen::Index k = 0; k < unknowns.count; ++k) {
    const double h = 1e-6;
    const TurntableModel next = moved(model, unknowns, h * Eigen::VectorXd::Unit(unknowns.count, k));
    const CentredPose there = pose_at(next, angle + next.angle_offset_rad[1]);
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(there.rotation * here.rotation.transpose()));
    PoseStep step;
    step << turn.angle() * turn.axis(), there.centre_in_camera - here.centre_in_camera;
    EXPECT_LT((step / h - d.col(k).head<6>()).norm(), 1e-4) << k;
  }
}

TEST(RegisterTurntable, SilhouettesAndTagsTogether) {
  const TurntableRegistration found =
      register_turntable(bench().silhouette, bench().views, bench().start(), bench().tags, bench().observed(0.05, 1), near_only());
  expect_views_found(found, 5e-5, 5e-4, 0.06);
  const Eigen::Vector3d axis = bench().table_from_mesh.linear().transpose() * bench().axis;
  EXPECT_LT(found.model.axis_in_mesh.cross(axis).norm() * 180.0 / std::numbers::pi, 0.06);
  for (const RegisteredView& view : found.views) EXPECT_NEAR(view.tag_rms_px, 0.05, 0.02);
}

TEST(RegisterTurntable, SilhouettesAlone) {
  const TurntableRegistration found = register_turntable(bench().silhouette, bench().views, bench().start(), {}, {}, near_only());
  expect_views_found(found, 5e-5, 2e-3, 0.08);
}

TEST(RegisterTurntable, AMeshThatLiesElsewhereIsSearched) {
  TurntableOptions options;
  options.rim_points = 3000;
  TurntableStart start = bench().start();
  start.table_from_mesh = bench().table_from_mesh;
  start.table_from_mesh.linear() *= Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 1, 1).normalized()).toRotationMatrix();
  start.table_from_mesh.translation() += Eigen::Vector3d(0.05, -0.04, 0.05);
  const TurntableRegistration found = register_turntable(bench().silhouette, bench().views, start, bench().tags, bench().observed(0.05, 2), options);
  expect_views_found(found, 5e-5, 5e-4, 0.06);
}

TEST(RegisterTurntable, AnglesThatAreOffAreFound) {
  std::vector<TurntableView> views = bench().views;
  views[2].angle_deg += 0.3;
  TurntableOptions options = near_only();
  options.angle_sigma_deg = 0.2;
  const TurntableRegistration found =
      register_turntable(bench().silhouette, views, bench().start(), bench().tags, bench().observed(0.05, 3), options);
  expect_views_found(found, 5e-5, 5e-4, 0.06);
  EXPECT_NEAR(found.model.angle_offset_rad[2] * 180.0 / std::numbers::pi, -0.3, 0.1);  // all others' mean offset is free within 0.2 / sqrt 6
}

TEST(RegisterTurntable, AnUncertainLensIsSaidToDominate) {
  TurntableOptions options = near_only();
  Eigen::Matrix<double, 8, 1> sigma;
  sigma << 30, 30, 10, 10, 0.05, 0.5, 1e-3, 1e-3;
  options.lens_covariance = Eigen::Matrix<double, 8, 8>(sigma.cwiseAbs2().asDiagonal());
  TurntableStart start = bench().start();
  start.camera.focal_x_px *= 1.005;
  start.camera.focal_y_px *= 1.005;
  const TurntableRegistration found =
      register_turntable(bench().silhouette, bench().views, start, {}, {}, options);  // tags would calibrate the lens
  ASSERT_TRUE(found.converged) << found.problem;
  for (int v = 0; v < kViews; ++v) {
    const RegisteredView& view = found.views[static_cast<std::size_t>(v)];
    EXPECT_STREQ(view.shares.dominant(), "lens");
    EXPECT_LT(pose_error(view.camera_from_mesh, bench().truth(v), bench().mesh).shift_m, 3.0 * view.sigma_m);
  }
}

TEST(RegisterTurntable, ASigmaForEachViewThatHolds) {
  // Tags are drawn anew; the silhouettes' noise is the same, so its error is common to all draws.
  double chi_turn = 0.0, chi_shift = 0.0;
  constexpr int kSeeds = 5;
  for (std::uint64_t seed = 10; seed < 10 + kSeeds; ++seed) {
    const TurntableRegistration found =
        register_turntable(bench().silhouette, bench().views, bench().start(), bench().tags, bench().observed(0.05, seed), near_only());
    const PoseError error = pose_error(found.views[1].camera_from_mesh, bench().truth(1), bench().mesh);
    chi_turn += std::pow(error.turn_deg / found.views[1].sigma_deg, 2) / kSeeds;
    chi_shift += std::pow(error.shift_m / found.views[1].sigma_m, 2) / kSeeds;
  }
  EXPECT_LT(std::sqrt(chi_turn), 2.0);
  EXPECT_LT(std::sqrt(chi_shift), 2.0);
}

TEST(RegisterTurntable, LightsGoToTheWorldWithTheirUncertainty) {
  const TurntableRegistration found =
      register_turntable(bench().silhouette, bench().views, bench().start(), bench().tags, bench().observed(0.05, 1), near_only());
  const Eigen::Vector3d light_in_mesh(0.5, 0.6, 0.7);
  LightInCamera seen{2, found.views[2].camera_from_mesh * light_in_mesh, 1e-6 * Eigen::Matrix3d::Identity()};
  const LightInMesh light = lights_in_mesh(found, {seen})[0];
  EXPECT_LT((light.position_m - light_in_mesh).norm(), 1e-12);
  EXPECT_GT(light.covariance.trace(), 3e-6);
  EXPECT_GT(light.pose_share, 0.0);
  EXPECT_LT(light.pose_share, 1.0);
  seen.view = 99;
  EXPECT_THROW(lights_in_mesh(found, {seen}), BadInput);
}

TEST(RegisterTurntable, BadInputIsNamed) {
  EXPECT_THROW(register_turntable(bench().silhouette, {}, bench().start(), {}, {}, {}), BadInput);
  std::vector<TagObservation> wrong = bench().observed(0.05, 1);
  wrong[0].view = 99;
  EXPECT_THROW(register_turntable(bench().silhouette, bench().views, bench().start(), bench().tags, wrong, near_only()), BadInput);
}

}  // namespace
}  // namespace lumitexel
