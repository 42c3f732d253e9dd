#include "rig/rig_description.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "rig/toml_table.h"
#include "rig/whole_file.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/small_rig.h"

namespace lumitexel {
namespace {

constexpr double kRounding = 1e-12;  // a few dozen operations on numbers near 1

void expect_rejected(const std::string& from, const std::string& to, const std::string& place, const std::string& part) {
  EXPECT_BAD_INPUT(parse_rig(with_replaced(small_rig_toml(), from, to), "bench.toml"), place, part);
}

TEST(RigDescription, TheSimulatedBenchIsRead) {
  const std::filesystem::path file = std::filesystem::path(LUMITEXEL_SOURCE_DIR) / "config/rigs/simulated.toml";
  const RigDescription rig = parse_rig(read_whole_file(file), file.string());
  EXPECT_EQ(rig.backend, "simulated");
  EXPECT_FALSE(rig.simulation_toml.empty());
}

TEST(RigDescription, ValuesLandWhereTheyBelong) {
  const RigDescription rig = small_rig();
  EXPECT_EQ(rig.camera.limits.width_px, 6);
  EXPECT_EQ(rig.camera.limits.mosaic, Mosaic::Rggb);
  EXPECT_EQ(rig.camera.lens.focal_y_px, 21.0);
  EXPECT_EQ(rig.camera.lens.p2, -0.0003);
  EXPECT_EQ(rig.camera.sensor.full_well_e, 18000.0);  // a whole number where a number is asked for
  EXPECT_EQ(rig.light_positioner.azimuth_min_deg, -110.0);
  EXPECT_EQ(rig.light_positioner.elevation_max_deg, 85.0);
  EXPECT_EQ(rig.spheres.count, 6);
  EXPECT_NEAR(rig.gray_card.normal_in_rig.norm(), 1.0, kRounding);
  EXPECT_TRUE(rig.simulation_toml.empty());
  EXPECT_EQ(rig.light_positioner.lamp_radius_m, 0.0);
  const std::string large = with_replaced(small_rig_toml(), "settle_s = 0.8", "settle_s = 0.8\nlamp_radius_m = 0.05");
  EXPECT_EQ(parse_rig(large, "rig.toml").light_positioner.lamp_radius_m, 0.05);
}

TEST(RigDescription, TheCameraLooksAlongZWithYDown) {
  const Eigen::Isometry3d pose = small_rig().camera.camera_from_rig;
  EXPECT_NEAR(pose.linear().determinant(), 1.0, kRounding);
  EXPECT_NEAR((pose * Eigen::Vector3d(1.0, 0.0, 0.5)).norm(), 0.0, kRounding);
  const Eigen::Vector3d target = pose * Eigen::Vector3d::Zero();
  EXPECT_NEAR((target - Eigen::Vector3d(0, 0, std::sqrt(1.25))).norm(), 0.0, kRounding);
  EXPECT_LT((pose * Eigen::Vector3d(0, 0, 0.1)).y(), 0.0);  // what is higher has smaller y
  EXPECT_GT((pose * Eigen::Vector3d(0, 0.1, 0)).x(), 0.0);  // seen from +x, rig +y lies to the right
}

TEST(RigDescription, TheTableTurnsRightHandedAboutItsAxis) {
  const Eigen::Isometry3d rig_from_table = small_rig().turntable.rig_from_table(90.0);
  EXPECT_NEAR((rig_from_table * Eigen::Vector3d(1.1, 0, 0.3) - Eigen::Vector3d(0.1, 1.0, 0.3)).norm(), 0.0, kRounding);
}

TEST(RigDescription, TheLightStandsOnItsSphere) {
  const LightPositionerDescription arm = small_rig().light_positioner;
  const Eigen::Vector3d expected(std::sqrt(0.5), std::sqrt(1.5), 0.1 + std::sqrt(2.0));
  EXPECT_NEAR((arm.nominal_position_in_rig(60.0, 45.0) - expected).norm(), 0.0, kRounding);
}

TEST(RigDescription, MistakesAreNamedByFileLineAndKey) {
  expect_rejected("width_px = 6", "width_px = -6", "bench.toml:5: camera.width_px: -6", "whole number");
  expect_rejected("width_px = 6", "width_px = 6.5", "bench.toml:5: camera.width_px: 6.5", "whole number");
  expect_rejected("bits = 12", "bits = 17", "bench.toml:7: camera.bits: 17", "16");
  expect_rejected("\"rggb\"", "\"rgb\"", "bench.toml:8: camera.mosaic: rgb", "rggb");
  expect_rejected("exposure_max_s = 30.0", "exposure_max_s = 1e-6", "bench.toml:10: camera.exposure_max_s", "min");
  expect_rejected("readout_s = 0.15", "readout_s = nan", "bench.toml:12: camera.readout_s", ">= 0");
  expect_rejected("[20.0, 21.0]", "[20.0]", "bench.toml:13: camera.focal_px: 1 values", "2");
  expect_rejected("[20.0, 21.0]", "[20.0, \"wide\"]", "bench.toml:13: camera.focal_px", "positive");
  expect_rejected("[20.0, 21.0]", "20.0", "bench.toml:13: camera.focal_px", "array");
  expect_rejected("full_well_e = 18000\n", "", "bench.toml:4: camera.full_well_e: missing", "positive");
  expect_rejected("full_well_e", "full_well", "bench.toml:4: camera.full_well_e: missing", "positive");
  expect_rejected("[1.0, 0.0, 0.5]", "[0.0, 0.0, 0.5]", "bench.toml:22: camera.up_in_rig: parallel", "viewing");
  expect_rejected("[0.0, 0.0, 2.0]", "[0.0, 0.0, 0.0]", "bench.toml:26: turntable.axis_direction_in_rig", "not zero");
  expect_rejected("[-110.0, 110.0]", "[110.0, -110.0]", "bench.toml:33: light_positioner.azimuth", "ascending");
  expect_rejected("settle_s = 0.8", "settle_s = 0.8\nlamp_radius_m = 0.5", "bench.toml:37: light_positioner.lamp_radius_m: 0.5", "0.4");
  expect_rejected("spacing_m = 0.050", "spacing_m = 0.030", "bench.toml:44: spheres.spacing_m", "overlap");
  expect_rejected("[ring_flash]\nradius_m = 0.04\n", "", "ring_flash: missing", "table");
  expect_rejected("[spheres]", "[spheres]\ncolour = 3", "bench.toml:42: spheres.colour: unknown key", "radius_m");
  expect_rejected("[spheres]", "[sphere]\n[spheres]", "bench.toml:41: sphere: unknown key", "spheres");
  expect_rejected("name = \"small bench\"", "name = ", "bench.toml:1", "TOML");
  expect_rejected("name = \"small bench\"", "name = \"\"", "bench.toml:1: name", "not empty");
}

// Its own reader reports lines, so they must stay where they are; nothing else of the file may show.
TEST(RigDescription, TheSimulationIsKeptAsTextOnItsLines) {
  const std::string table = "[simulation]\nseed = 7 # kept\n[[simulation.material]]\nname = \"a\"\n";
  const RigDescription rig =
      parse_rig(with_replaced(small_rig_toml(), "[spheres]", table + "\n# about spheres\n[spheres]"), "bench.toml");
  const TomlTable simulation = TomlTable::parse(rig.simulation_toml, "bench.toml").table("simulation");
  EXPECT_EQ(simulation.integer("seed", 0, 100), 7);
  EXPECT_EQ(simulation.tables("material").front().string("name"), "a");
  EXPECT_NE(rig.simulation_toml.find("# kept"), std::string::npos);
  EXPECT_EQ(rig.simulation_toml.find("albedo"), std::string::npos);
  EXPECT_BAD_INPUT(simulation.integer("seed", 0, 5), "bench.toml:42: simulation.seed: 7");
}

}  // namespace
}  // namespace lumitexel
