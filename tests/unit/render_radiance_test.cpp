#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <numbers>

#include "sim/placed_scene.h"
#include "sim/render_radiance.h"
#include "simulated_bench.h"

namespace lumitexel {
namespace {

// Where the ray through a pixel's centre meets the gray card's plane, in the rig's frame.
Eigen::Vector3d on_card_plane(const RigDescription& rig, const CameraModel& camera, int x, int y) {
  const Eigen::Isometry3d rig_from_camera = rig.camera.camera_from_rig.inverse();
  const Eigen::Vector3d ray = rig_from_camera.linear() * camera.unproject({x + 0.5, y + 0.5});
  const Eigen::Vector3d normal = rig.gray_card.normal_in_rig.normalized();
  const double distance = normal.dot(rig.gray_card.centre_in_rig - rig_from_camera.translation()) / normal.dot(ray);
  return rig_from_camera.translation() + distance * ray;
}

Eigen::Vector2i pixel_of(const RigDescription& rig, const CameraModel& camera, const Eigen::Vector3d& x_in_rig) {
  return camera.project(rig.camera.camera_from_rig * x_in_rig).array().floor().cast<int>();
}

TEST(RenderRadiance, TheGrayCardFollowsTheInverseSquareAndCosineLaws) {
  const auto world = small_world();
  RadianceRenderer renderer(world);
  const RigDescription& rig = world->rig;
  const auto image = renderer.render({.light_azimuth_deg = -25, .light_elevation_deg = 40, .point_light = true});
  const Eigen::Vector3d light = rig.light_positioner.radius_m *
                                Eigen::Vector3d(std::cos(40 * M_PI / 180) * std::cos(25 * M_PI / 180),
                                                -std::cos(40 * M_PI / 180) * std::sin(25 * M_PI / 180),
                                                std::sin(40 * M_PI / 180));
  const Eigen::Vector2i centre = pixel_of(rig, world->camera, rig.gray_card.centre_in_rig);
  for (const int dx : {-8, 0, 8}) {
    for (const int dy : {-8, 0, 8}) {
      const Eigen::Vector3d point = on_card_plane(rig, world->camera, centre.x() + dx, centre.y() + dy);
      const Eigen::Vector3d to_light = light - point;
      const double cosine = rig.gray_card.normal_in_rig.normalized().dot(to_light.normalized());
      const double expected = 0.18 / std::numbers::pi * 10.0 * cosine / to_light.squaredNorm();
      for (int c = 0; c < 3; ++c) {
        // The pixel's box of 1.3 mm sees a field that is linear to 1e-5; float holds 1e-7.
        EXPECT_NEAR(image->at(centre.x() + dx, centre.y() + dy, c), expected, 1e-4 * expected);
      }
    }
  }
}

TEST(RenderRadiance, TheArmsHiddenErrorsMoveTheLight) {
  SimulationSettings settings = plain_settings();
  settings.arm_offset_m = {0.004, -0.005, 0.003};
  settings.arm_azimuth_error_deg = 0.5;
  settings.arm_elevation_error_deg = -0.25;
  const auto world = small_world(small_bench(), settings);
  const double azimuth = 30.5 * M_PI / 180, elevation = 19.75 * M_PI / 180;
  const Eigen::Vector3d expected(0.004 + std::cos(elevation) * std::cos(azimuth),
                                 -0.005 + std::cos(elevation) * std::sin(azimuth), 0.003 + std::sin(elevation));
  EXPECT_NEAR((world->point_light_in_rig(30, 20) - expected).norm(), 0.0, 1e-12);
}

// With a ring of no radius the light stands in the lens: every highlight lies where its sphere's centre projects.
TEST(RenderRadiance, SphereHighlightsOfALightInTheLensProjectToTheCentres) {
  RigDescription rig = small_bench();
  rig.ring_flash.radius_m = 0.0;
  SimulationSettings settings = plain_settings();
  settings.ring_flash_emitters = 1;
  settings.samples_per_pixel = 16;
  const auto world = small_world(rig, settings);
  RadianceRenderer renderer(world);
  const auto image = renderer.render({.turntable_deg = 77, .ring_flash = true});
  for (const Eigen::Vector3d& centre : world->sphere_centres_in_rig()) {
    const Eigen::Vector2d expected = world->camera.project(rig.camera.camera_from_rig * centre);
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    double weight = 0.0;
    for (int dy = -5; dy <= 5; ++dy) {
      for (int dx = -5; dx <= 5; ++dx) {
        const int x = static_cast<int>(expected.x()) + dx, y = static_cast<int>(expected.y()) + dy;
        const double value = image->at(x, y, 1);
        moment += value * Eigen::Vector2d(x + 0.5, y + 0.5);
        weight += value;
      }
    }
    // 16 samples a pixel on a highlight of 0.4 px sigma; the window cuts its wide tail off centre.
    EXPECT_NEAR((moment / weight - expected).norm(), 0.0, 0.1);
  }
}

TEST(RenderRadiance, ASphereThrowsItsShadowOntoTheCard) {
  RigDescription rig = small_bench();
  SimulationSettings settings = plain_settings();
  rig.spheres.count = 1;
  rig.spheres.radius_m = 0.008;
  const Eigen::Vector3d light = small_world()->point_light_in_rig(-25, 40);
  // Between light and card, 10 cm in front of the card and outside the camera's sight of it.
  settings.first_sphere_in_rig_m =
      rig.gray_card.centre_in_rig + 0.1 * (light - rig.gray_card.centre_in_rig).normalized();
  const auto world = small_world(rig, settings);
  RadianceRenderer renderer(world);
  const auto image = renderer.render({.light_azimuth_deg = -25, .light_elevation_deg = 40, .point_light = true});
  const Eigen::Vector2i centre = pixel_of(rig, world->camera, rig.gray_card.centre_in_rig);
  int dark = 0, bright = 0;
  for (int dy = -9; dy <= 9; ++dy) {
    for (int dx = -9; dx <= 9; ++dx) {
      const Eigen::Vector3d point = on_card_plane(rig, world->camera, centre.x() + dx, centre.y() + dy);
      const Eigen::Vector3d eye = rig.camera.camera_from_rig.inverse().translation();
      const auto miss = [&](const Eigen::Vector3d& from) {  // how near the sphere's centre the line of sight passes
        const Eigen::Vector3d along = (from - point).normalized(), to = settings.first_sphere_in_rig_m - point;
        return (to - along.dot(to) * along).norm();
      };
      constexpr double kEdge_m = 0.0018;  // a pixel's diagonal on the card: only there is the answer mixed
      if (miss(eye) < rig.spheres.radius_m + kEdge_m) continue;
      const double past = miss(light) - rig.spheres.radius_m;
      const float value = image->at(centre.x() + dx, centre.y() + dy, 0);
      if (past < -kEdge_m) {
        ++dark;
        EXPECT_EQ(value, 0.0f);
      } else if (past > kEdge_m) {
        ++bright;
        EXPECT_GT(value, 0.1f);
      }
    }
  }
  EXPECT_GT(dark, 30);
  EXPECT_GT(bright, 100);
}

TEST(PlacedScene, TheObjectShadesCardAndSpheresAndTurnsWithTheTable) {
  const auto world = small_world();
  for (const double angle : {0.0, 120.0}) {
    const PlacedScene scene(*world, angle);
    SceneHit card;
    card.part = ScenePart::GrayCard;
    card.point = scene.mesh_from_rig() * world->rig.gray_card.centre_in_rig;
    SceneHit sphere;
    sphere.part = ScenePart::Sphere;  // its lowest point
    sphere.point = scene.mesh_from_rig() * (world->sphere_centres_in_rig()[2] - Eigen::Vector3d(0, 0, 0.02));
    const auto beyond_axis = [&](const SceneHit& from) {  // a light on the far side of the turntable's axis
      return Eigen::Vector3d(from.point + 8.0 * (Eigen::Vector3d(0, 0, -0.01) - from.point));
    };
    EXPECT_TRUE(scene.shadowed(card, beyond_axis(card)));
    EXPECT_TRUE(scene.shadowed(sphere, beyond_axis(sphere)));
    EXPECT_FALSE(scene.shadowed(card, card.point + 2.0 * (card.point - Eigen::Vector3d(0, 0, -0.01))));
  }
}

TEST(RenderRadiance, TheBacklightIsSeenOnlyWhenLitAndOnlyPastTheParts) {
  const auto world = small_world();
  RadianceRenderer renderer(world);
  const auto lit = renderer.render({.backlight = true});
  const Eigen::Vector2i object = pixel_of(world->rig, world->camera, {0, 0, 0});
  EXPECT_EQ(lit->at(object.x(), object.y(), 0), 0.0f);
  EXPECT_EQ(lit->at(2, 96, 0), 2.0f);
  const auto unlit = renderer.render({.point_light = true});
  EXPECT_EQ(unlit->at(2, 96, 0), 0.0f);
  EXPECT_GT(unlit->at(object.x(), object.y(), 0), 0.0f);
}

TEST(RenderRadiance, DoesNotDependOnTheNumberOfThreads) {
  const auto world = small_world();
  const WorldState state{.turntable_deg = 33, .light_azimuth_deg = 10, .light_elevation_deg = 30,
                         .point_light = true, .ring_flash = true};
  std::vector<float> images[2];
  for (const std::size_t threads : {1u, 2u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    images[threads - 1] = RadianceRenderer(world).render(state)->data;
  }
  EXPECT_EQ(images[0], images[1]);
}

TEST(RenderRadiance, InterpolatedRaysAreTheLensesRays) {
  const auto world = small_world();
  const RadianceRenderer renderer(world);
  for (const Eigen::Vector2d& pixel : {Eigen::Vector2d(0.3, 0.7), {200.5, 13.2}, {255.9, 191.9}, {128.4, 96.6}}) {
    const Eigen::Vector2d back = world->camera.project(renderer.direction_in_camera(pixel.x(), pixel.y()));
    EXPECT_NEAR((back - pixel).norm(), 0.0, 1e-4);  // at the shipped bench's focal length 16 times less
  }
}

}  // namespace
}  // namespace lumitexel
