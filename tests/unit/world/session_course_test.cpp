// Lamp and sensor change with the shot's number alone; the stage is part of what a frame is.
#include <gtest/gtest.h>

#include <numeric>

#include "sim/render_radiance.h"
#include "sim/session_drift.h"
#include "sim/simulated_bench.h"
#include "sim/simulated_rig.h"
#include "sim/state_strip.h"
#include "tests/unit/simulated_bench.h"

namespace lumitexel {
namespace {

SimulationSettings drifting() {
  SimulationSettings settings = plain_settings();
  settings.lamp_drift = -0.05;
  settings.sensor_warming_k = 5.0;
  settings.hot_pixel_fraction = 0.0;
  return settings;
}

double mean_of(const Frame& frame) {
  return std::accumulate(frame.samples.begin(), frame.samples.end(), 0.0) / static_cast<double>(frame.samples.size());
}

// Light of one frame over the other's, over the pixels that the first one shows lit and far from saturated.
double light_ratio(const Frame& frame, const Frame& first) {
  constexpr int kBlack = 256, kLit = 1500, kBright = 12000;
  double sum = 0, first_sum = 0;
  for (std::size_t i = 0; i < first.samples.size(); ++i) {
    if (first.samples[i] < kLit || first.samples[i] > kBright) continue;
    sum += frame.samples[i] - kBlack;
    first_sum += first.samples[i] - kBlack;
  }
  return sum / first_sum;
}

TEST(SessionCourse, GoesFromNothingToWhatIsSaidAndStays) {
  const BenchBehaviour behaviour = drifting();
  EXPECT_EQ(lamp_strength_at(behaviour, 1), 1.0);
  EXPECT_NEAR(lamp_strength_at(behaviour, 101), 0.95, 1e-12);
  EXPECT_EQ(lamp_strength_at(behaviour, 500), lamp_strength_at(behaviour, 101));
  EXPECT_EQ(sensor_warming_at(behaviour, 1), 0.0);
  EXPECT_NEAR(sensor_warming_at(behaviour, 101), 5.0, 1e-12);
  for (std::uint64_t key = 1; key < 150; ++key) {
    EXPECT_LT(std::abs(lamp_strength_at(behaviour, key + 1) - lamp_strength_at(behaviour, key)), 0.004);  // smooth
    EXPECT_LE(sensor_warming_at(behaviour, key), sensor_warming_at(behaviour, key + 1));
  }
}

TEST(SessionCourse, ShowsInTheFramesWhateverWasTakenBefore) {
  const auto world = small_world(small_bench(), drifting());
  RigDevices devices = make_simulated_devices(small_bench(), world);
  devices.point_light->switch_to(true, {});
  const Frame first = devices.camera->shoot({0.02, 0.0}, {}, 1), late = devices.camera->shoot({0.02, 0.0}, {}, 101);
  // Thousands of pixels with 1500 to 14000 electrons each: noise below 5e-4; dark current adds 0.1 electrons.
  EXPECT_NEAR(light_ratio(late, first), 0.95, 0.002);
  EXPECT_EQ(first.sensor_temperature_c, 25.0);
  EXPECT_NEAR(late.sensor_temperature_c, 30.0, 1e-12);
  devices.point_light->switch_to(false, {});
  const double dark_first = mean_of(devices.camera->shoot({20.0, 0.0}, {}, 2)) - 256.0;
  const double dark_late = mean_of(devices.camera->shoot({20.0, 0.0}, {}, 102)) - 256.0;
  const double kelvin = 5.0 - sensor_warming_at(drifting(), 2);
  EXPECT_NEAR(dark_late / dark_first, std::exp2(kelvin / 7.0), 0.005);  // 50 electrons, over 49152 pixels

  RigDevices resumed = make_simulated_devices(small_bench(), world);
  resumed.point_light->switch_to(true, {});
  EXPECT_EQ(resumed.camera->shoot({0.02, 0.0}, {}, 101).samples, late.samples);
}

TEST(SessionCourse, ABracketRendersOnce) {
  RadianceRenderer renderer(small_world(small_bench(), drifting()));
  WorldState state{.light_elevation_deg = 30, .point_light = true};
  const auto picture = renderer.render(state);
  state.lamp_strength = 0.97;
  state.sensor_warming_k = 3;
  EXPECT_EQ(renderer.render(state), picture);
}

TEST(SessionCourse, TheStageIsInTheStateStripAndOldStripsAreAsTheyWere) {
  StateStrip strip{{0.02, 6.0}, {.turntable_deg = 33, .ring_flash = true}, 7, 9};
  std::vector<std::uint16_t> plain(kStateStripPixels), samples(kStateStripPixels);
  write_state_strip(strip, 14, plain);
  EXPECT_EQ(read_state_strip(plain, 14)->state, strip.state);
  strip.state.board = 13;
  strip.state.flat_field = true;
  write_state_strip(strip, 14, samples);
  const auto read = read_state_strip(samples, 14);
  ASSERT_TRUE(read);
  EXPECT_EQ(read->state, strip.state);
  EXPECT_EQ(read->exposure_count, 9u);
  EXPECT_NE(samples, plain);
}

TEST(SessionCourse, TheStageHandChangesWhatTheCameraSees) {
  RigDescription rig = small_bench();
  rig.board = {.columns = 5, .rows = 4, .pitch_m = 0.02, .albedo = 0.8};
  RigDevices devices = make_simulated_devices(rig, small_world(rig));
  ASSERT_TRUE(devices.stage);
  devices.ring_flash->switch_to(true, {});
  const double object = mean_of(devices.camera->shoot({0.02, 0.0}, {}, 1));
  devices.stage->place({Prop::Kind::Board, 1}, {});
  const double board = mean_of(devices.camera->shoot({0.02, 0.0}, {}, 1));
  devices.ring_flash->switch_to(false, {});
  const double dark = mean_of(devices.camera->shoot({0.02, 0.0}, {}, 1));
  devices.stage->place({Prop::Kind::Diffuser, 0}, {});
  const double flat = mean_of(devices.camera->shoot({0.02, 0.0}, {}, 1));
  EXPECT_GT(std::abs(board - object), 100.0);
  EXPECT_NEAR(dark, 256.0, 2.0);
  EXPECT_NEAR(flat, 256.0 + 0.8 * 2e5 * 0.02 / 1.2, 3.0);
}

}  // namespace
}  // namespace lumitexel
