// The hidden errors: each moves what it says by how much it says, and none moves nothing.
#include "sim/true_rig.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>

#include "rig/rig_file.h"
#include "sim/board_placements.h"
#include "sim/point_lamp.h"
#include "sim/render_radiance.h"
#include "sim/sensor.h"
#include "sim/simulated_rig.h"
#include "tests/unit/simulated_bench.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

constexpr double kRounding = 1e-12;
double radians(double deg) { return deg * std::numbers::pi / 180.0; }

TEST(TrueRig, WithoutErrorsIsTheDescriptionToTheBit) {
  const RigDescription described = small_bench();
  const RigDescription real = true_rig(described, plain_settings());
  EXPECT_EQ(real.camera.camera_from_rig.matrix(), described.camera.camera_from_rig.matrix());
  EXPECT_EQ(real.camera.lens.focal_x_px, described.camera.lens.focal_x_px);
  EXPECT_EQ(real.turntable.axis_direction_in_rig, described.turntable.axis_direction_in_rig);
  EXPECT_EQ(real.gray_card.normal_in_rig, described.gray_card.normal_in_rig);
  EXPECT_EQ(true_table_from_mesh(plain_settings()).matrix(), Eigen::Matrix4d::Identity());
}

TEST(TrueRig, EveryPartIsOffByWhatTheSettingsSay) {
  SimulationSettings settings = plain_settings();
  settings.lens_focal_error = 0.005;
  settings.lens_principal_error_px = {3.0, -2.0};
  settings.lens_distortion_error = {0.01, 0.02, 0.003, 0.004};
  settings.camera_position_error_m = {0.003, 0.0, 0.0};
  settings.camera_rotation_error_deg = {0.0, 0.3, 0.0};
  settings.table_axis_tilt_deg = {0.1, 0.0};
  settings.card_shift_m = {0.0, 0.002, 0.0};
  settings.card_turn_deg = {2.0, 0.0, 0.0};
  RigDescription described = small_bench();
  described.tags.resize(2);
  described.tags[0].id = 20;
  described.tags[1].id = 21;
  described.tags[0].centre = described.tags[1].centre = described.gray_card.centre_in_rig + Eigen::Vector3d(0, 0.03, 0);
  described.gray_card.tag_ids = {20};
  const RigDescription real = true_rig(described, settings);
  EXPECT_DOUBLE_EQ(real.camera.lens.focal_y_px, 737.5 * 1.005);
  EXPECT_DOUBLE_EQ(real.camera.lens.principal_y_px, 93.0);
  EXPECT_DOUBLE_EQ(real.camera.lens.p2, -0.0003 + 0.004);
  const Eigen::Vector3d eye = real.camera.camera_from_rig.inverse().translation();
  EXPECT_NEAR((eye - described.camera.camera_from_rig.inverse().translation() - Eigen::Vector3d(0.003, 0, 0)).norm(), 0,
              kRounding);
  // The camera turned by 0.3 degrees about its down axis: what was ahead lies by that to the side.
  const Eigen::Vector3d ahead = real.camera.camera_from_rig.linear() *
                                described.camera.camera_from_rig.linear().transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR((ahead - Eigen::Vector3d(std::sin(radians(0.3)), 0, std::cos(radians(0.3)))).norm(), 0, kRounding);
  EXPECT_NEAR(std::acos(real.turntable.axis_direction_in_rig.z()), radians(0.1), 1e-9);
  // The card's tag goes with the card, the other one stays.
  const Eigen::Vector3d arm = real.tags[0].centre - real.gray_card.centre_in_rig;
  EXPECT_NEAR((arm - 0.03 * Eigen::Vector3d(0, std::cos(radians(2)), std::sin(radians(2)))).norm(), 0, kRounding);
  EXPECT_EQ(real.tags[1].centre, described.tags[1].centre);
}

TEST(TrueRig, ADisplacedObjectIsTruthInTheMeshsFrame) {
  SimulationSettings settings = plain_settings();
  settings.object_shift_m = {0.005, -0.003, 0.002};
  settings.object_turn_deg = {0.0, 0.0, 3.0};
  settings.table_axis_point_error_m = {0.001, 0.0, 0.0};
  const auto displaced = small_world(small_bench(), settings), plain = small_world();
  CapturePlan plan;
  plan.views.push_back({.name = "v", .turntable_deg = 70, .light_azimuth_deg = 20, .light_elevation_deg = 40});
  const TemporaryFolder folder;
  write_truth(*displaced, small_bench(), plan, folder / "truth");
  std::ifstream stream(folder / "truth/calibration.json");
  const nlohmann::json truth = nlohmann::json::parse(stream);
  Eigen::Isometry3d camera_from_world = Eigen::Isometry3d::Identity();
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 4; ++j) {
      camera_from_world(static_cast<int>(i), static_cast<int>(j)) = truth["poses"][0]["camera_from_world"][i][j];
    }
  }
  // A mesh point by hand: turned by 3 degrees, shifted, turned by 70 degrees about the displaced axis, seen.
  const Eigen::Vector3d x(0.03, 0.02, 0.05);
  const auto about_z = [](double deg) { return Eigen::AngleAxisd(radians(deg), Eigen::Vector3d::UnitZ()); };
  const Eigen::Vector3d in_table = about_z(3) * x + settings.object_shift_m, axis(0.001, 0, 0);
  const Eigen::Vector3d in_rig = about_z(70) * (in_table - axis) + axis;
  EXPECT_NEAR((camera_from_world * x - small_bench().camera.camera_from_rig * in_rig).norm(), 0, kRounding);
  EXPECT_EQ(displaced->scan.positions, plain->scan.positions);
  EXPECT_EQ(displaced->object.positions, plain->object.positions);
  // The light, in that frame, is as far from the mesh point as in the rig's.
  const auto& at = truth["lights"][0]["position_m"];
  EXPECT_NEAR((Eigen::Vector3d(at[0], at[1], at[2]) - x).norm(), (displaced->point_light_in_rig(20, 40) - in_rig).norm(),
              kRounding);
}

TEST(TrueRig, TheFlatFieldShowsTheVignettingAndNothingElse) {
  SimulationSettings settings = plain_settings();
  settings.vignetting = {-0.1, -0.04, 0.01};
  const auto world = small_world(small_bench(), settings);
  RadianceRenderer renderer(world);
  const auto image = renderer.render({.turntable_deg = 30, .point_light = true, .flat_field = true});
  const double half_diagonal_px = 160.0;  // of 256 x 192
  for (const auto& [x, y] : {std::pair{129, 95}, {0, 0}, {255, 191}, {20, 150}}) {
    const double r2 = (std::pow(x + 0.5 - 129.0, 2) + std::pow(y + 0.5 - 95.0, 2)) / std::pow(half_diagonal_px, 2);
    const double expected = 0.8 * (1.0 + r2 * (-0.1 + r2 * (-0.04 + r2 * 0.01)));
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(image->at(x, y, c), expected, 1e-6);  // floats
  }
  // Every picture has it: the same scene without, times the factor.
  RadianceRenderer bright(small_world());
  const WorldState lit{.light_elevation_deg = 40, .point_light = true};
  const Eigen::Vector2i card = world->camera.project(world->rig.camera.camera_from_rig *
                                                     world->rig.gray_card.centre_in_rig).array().floor().cast<int>();
  const double share = vignetting_at(world->rig.camera, settings.vignetting, card.x() + 0.5, card.y() + 0.5);
  EXPECT_NEAR(renderer.render(lit)->at(card.x(), card.y(), 1) / bright.render(lit)->at(card.x(), card.y(), 1), share, 1e-6);
  EXPECT_LT(share, 0.97);
}

TEST(PointLamp, ThePatternIsACosinesPowerAboutATiltedAxis) {
  SimulationSettings settings = plain_settings();
  settings.lamp_pattern_exponent = 8.0;
  const auto straight = small_world(small_bench(), settings);
  const Eigen::Vector3d light = straight->point_light_in_rig(20, 40);
  EXPECT_NEAR((lamp_axis_in_rig(*straight, 20, 40) + light.normalized()).norm(), 0, kRounding);  // at the pivot
  settings.lamp_pattern_tilt_deg = {4.0, 0.0};
  const auto tilted = small_world(small_bench(), settings);
  EXPECT_NEAR(std::acos(lamp_axis_in_rig(*tilted, 20, 40).dot(-light.normalized())), radians(4.0), 1e-9);
  const Emitter lamp = point_lamp_in_rig(*straight, 20, 40).front();
  EXPECT_NEAR(lamp.intensity_along(Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX().cross(lamp.axis).normalized()) * lamp.axis)[0],
              10.0 * std::pow(std::cos(0.3), 8), 1e-9);
  // And the card is lit by it.
  RadianceRenderer with(straight), without(small_world());
  const WorldState lit{.light_azimuth_deg = 20, .light_elevation_deg = 40, .point_light = true};
  const Eigen::Vector3d card = straight->rig.gray_card.centre_in_rig;
  const Eigen::Vector2i pixel = straight->camera.project(straight->rig.camera.camera_from_rig * card).array().floor().cast<int>();
  const double cosine = (card - light).normalized().dot(lamp.axis);
  EXPECT_NEAR(with.render(lit)->at(pixel.x(), pixel.y(), 0) / without.render(lit)->at(pixel.x(), pixel.y(), 0),
              std::pow(cosine, 8), 2e-3);  // the pixel's centre is up to 0.7 mm off the card's
}

TEST(PointLamp, ALargeLampIsAsStrongAndStandsAtTheSamePlace) {
  SimulationSettings settings = plain_settings();
  settings.lamp_radius_m = 0.02;
  const auto world = small_world(small_bench(), settings);
  const Eigen::Vector3d light = world->point_light_in_rig(20, 40);
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  double sum = 0, second_moment = 0;
  for (const Emitter& emitter : point_lamp_in_rig(*world, 20, 40)) {
    mean += emitter.position / kLampEmitters;
    sum += emitter.w_per_sr[0];
    second_moment += (emitter.position - light).squaredNorm() / kLampEmitters;
    EXPECT_NEAR((emitter.position - light).dot(light), 0, kRounding);  // a disc that faces the pivot
  }
  EXPECT_NEAR((mean - light).norm(), 0, kRounding);
  EXPECT_NEAR(sum, 10.0, 1e-9);
  EXPECT_NEAR(second_moment, 0.5 * 0.02 * 0.02, 0.02 * 0.02 * 0.02);  // a disc's; 2 % for its being 48 points
}

TEST(SensorResponseCurve, RisesFromBlackToFullScale) {
  for (const SensorResponse response : {SensorResponse::Linear, SensorResponse::Gamma, SensorResponse::LogShoulder}) {
    EXPECT_NEAR(response_at(response, 0.0), 0.0, kRounding);
    EXPECT_NEAR(response_at(response, 1.0), 1.0, kRounding);
    for (int i = -10; i < 1000; ++i) {  // read noise reaches a little below black
      EXPECT_LT(response_at(response, 1e-3 * i), response_at(response, 1e-3 * (i + 1))) << i;
    }
    EXPECT_EQ(sensor_response_named(to_string(response)), response);
  }
  EXPECT_GT(response_at(SensorResponse::Gamma, 0.2), 0.35);
  EXPECT_GT(response_at(SensorResponse::LogShoulder, 0.5), 0.55);
}

TEST(SensorResponseCurve, IsWhatTheCodesFollow) {
  RigDescription rig = small_bench();
  rig.camera.sensor.read_noise_e = 0.0;
  SimulationSettings settings = plain_settings();
  settings.hot_pixel_fraction = settings.dark_current_e_per_s = 0.0;
  settings.response = SensorResponse::Gamma;
  Image radiance(256, 192, 3);
  std::fill(radiance.data.begin(), radiance.data.end(), 0.5f);
  double mean = 0;
  const SimulatedSensor sensor(rig.camera, settings);
  for (const std::uint16_t code : sensor.expose(radiance, {0.1, 0.0}, 5)) mean += code / (256.0 * 192.0);
  const double share = 0.5 * 2e5 * 0.1 / 18000.0;
  EXPECT_NEAR(mean, 256.0 + 18000.0 / 1.2 * response_at(SensorResponse::Gamma, share), 1.0);  // sigma of the mean: 0.2
}

}  // namespace
}  // namespace lumitexel
