#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "processing/image/exr_file.h"
#include "processing/surface/mesh_file.h"
#include "sim/simulated_rig.h"
#include "simulated_bench.h"
#include "temporary_folder.h"

namespace lumitexel {
namespace {

Eigen::Isometry3d pose_of(const nlohmann::json& rows) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  for (int i = 0; i < 4; ++i) {
    for (int j = 0; j < 4; ++j) pose.matrix()(i, j) = rows.at(static_cast<std::size_t>(i)).at(static_cast<std::size_t>(j));
  }
  return pose;
}

TEST(SimulatedTruth, SaysWhereLightAndCameraStoodAndWhatTheyShowed) {
  SimulationSettings settings = plain_settings();
  settings.arm_offset_m = {0.004, -0.005, 0.003};
  const auto world = small_world(small_bench(), settings);
  CapturePlan plan;
  plan.views.push_back({.name = "fit_000", .turntable_deg = 90, .light_azimuth_deg = 20, .light_elevation_deg = 40});
  const TemporaryFolder folder;
  write_truth(*world, world->rig, plan, folder / "truth");

  std::ifstream stream(folder / "truth/calibration.json");
  const nlohmann::json truth = nlohmann::json::parse(stream);
  EXPECT_EQ(truth.at("lights").at(0).at("view"), "fit_000");
  const auto& at = truth.at("lights").at(0).at("position_m");
  // The table has turned by 90 degrees, so that what is at (x, y) on the bench is at (y, -x) on the table.
  const Eigen::Vector3d in_rig = world->point_light_in_rig(20, 40);
  EXPECT_NEAR((Eigen::Vector3d(at[0], at[1], at[2]) - Eigen::Vector3d(in_rig.y(), -in_rig.x(), in_rig.z())).norm(), 0,
              1e-12);
  // 10 W/sr, 2e5 electrons a second per radiance, 1.2 electrons a sample.
  EXPECT_NEAR(truth.at("scale").at("value").at(1).get<double>(), 10.0 * 2e5 / 1.2, 1e-6);
  const Eigen::Isometry3d camera_from_world = pose_of(truth.at("poses").at(0).at("camera_from_world"));
  EXPECT_NEAR((camera_from_world.inverse().translation() - Eigen::Vector3d(0, -std::sqrt(0.75), 0.5)).norm(), 0, 1e-12);

  EXPECT_EQ(read_mesh(folder / "truth/mesh.ply").triangles.size(), world->object.triangles.size());
  const Image normal = read_exr_colour(folder / "truth/fit_000_normal.exr");
  const Image material = read_exr_colour(folder / "truth/fit_000_material.exr");
  int object = 0;
  for (int y = 0; y < normal.height; ++y) {
    for (int x = 0; x < normal.width; ++x) {
      const Eigen::Vector3d n(normal.at(x, y, 0), normal.at(x, y, 1), normal.at(x, y, 2));
      const float index = material.at(x, y);
      EXPECT_EQ(n.norm() > 0.0, index > 0.0f);
      if (index == 0.0f) continue;
      ++object;
      EXPECT_NEAR(n.norm(), 1.0, 1e-3);  // stored in half floats
      EXPECT_TRUE(index == 1.0f || index == 2.0f || index == 3.0f || index == 4.0f);
      // Seen from outside: the surface faces the camera, but for the relief's interpolated normals at the rim.
      EXPECT_GT(n.dot(camera_from_world.inverse().translation().normalized()), -0.3);
    }
  }
  EXPECT_GT(object, 256 * 192 / 10);
}

}  // namespace
}  // namespace lumitexel
