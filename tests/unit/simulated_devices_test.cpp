#include <gtest/gtest.h>

#include <cmath>

#include "drivers/error.h"
#include "sim/simulated_rig.h"
#include "simulated_bench.h"

namespace lumitexel {
namespace {

RigDevices fresh_devices() {
  static const std::shared_ptr<SimulatedWorld> world = small_world();
  return make_simulated_devices(world->rig, world);
}

TEST(SimulatedDevices, MovesTakeTheirTimeAndEndWhereTheyWereSent) {
  RigDevices devices = fresh_devices();
  devices.turntable->move_to(90.0, {});
  EXPECT_NEAR(devices.clock->now_s(), 90.0 / 20.0 + 0.5, 1e-12);
  EXPECT_EQ(devices.turntable->position(), 90.0);
  devices.turntable->move_to(90.0, {});
  EXPECT_NEAR(devices.clock->now_s(), 5.0, 1e-12);
  devices.turntable->move_to(350.0, {});  // 100 degrees backwards, not 260 forwards
  EXPECT_NEAR(devices.clock->now_s(), 5.0 + 5.5, 1e-12);
  devices.turntable->move_to(-10.0, {});  // the same place
  EXPECT_EQ(devices.turntable->position(), 350.0);
  EXPECT_NEAR(devices.clock->now_s(), 10.5, 1e-12);
  devices.light_elevation->move_to(30.0, {});
  EXPECT_NEAR(devices.clock->now_s(), 10.5 + 2.0 + 0.8, 1e-12);
}

TEST(SimulatedDevices, RefuseWhatLiesBeyondTheirLimitsWithoutMoving) {
  RigDevices devices = fresh_devices();
  EXPECT_THROW(devices.light_azimuth->move_to(111.0, {}), OutOfRange);
  EXPECT_THROW(devices.light_elevation->move_to(-21.0, {}), OutOfRange);
  EXPECT_THROW(devices.turntable->move_to(std::nan(""), {}), OutOfRange);
  EXPECT_THROW(devices.turntable->move_to(INFINITY, {}), OutOfRange);
  EXPECT_THROW(devices.camera->shoot({.exposure_s = 31.0}, {}), OutOfRange);
  EXPECT_EQ(devices.clock->now_s(), 0.0);
  EXPECT_EQ(devices.light_azimuth->position(), 0.0);
}

TEST(SimulatedDevices, LampsSettleAndGoOffAtOnceWhenForced) {
  RigDevices devices = fresh_devices();
  devices.point_light->switch_to(true, {});
  EXPECT_TRUE(devices.point_light->is_on());
  EXPECT_FALSE(devices.ring_flash->is_on());
  EXPECT_NEAR(devices.clock->now_s(), 0.1, 1e-12);
  devices.point_light->force_off();
  EXPECT_FALSE(devices.point_light->is_on());
  EXPECT_NEAR(devices.clock->now_s(), 0.1, 1e-12);
}

TEST(SimulatedDevices, AFrameTakesExposureAndReadoutAndSaysWhatItIs) {
  RigDevices devices = fresh_devices();
  const Frame frame = devices.camera->shoot({.exposure_s = 0.25}, {}, 42);
  EXPECT_NEAR(devices.clock->now_s(), 0.25 + 0.15, 1e-12);
  EXPECT_NEAR(frame.device_time_s, 0.25, 1e-12);
  EXPECT_EQ(frame.frame_key, 42u);
  EXPECT_EQ(frame.reported.exposure_s, 0.25);
  EXPECT_EQ(frame.samples.size(), 256u * 192);
  EXPECT_EQ(frame.mosaic, Mosaic::Rggb);
  EXPECT_EQ(frame.sensor_temperature_c, 25.0);
}

TEST(SimulatedDevices, AStoppedMoveOrExposureThrowsCancelled) {
  RigDevices devices = fresh_devices();
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(devices.turntable->move_to(10.0, stop.get_token()), Cancelled);
  EXPECT_EQ(devices.turntable->position(), 0.0);
  EXPECT_THROW(devices.camera->shoot({.exposure_s = 0.1}, stop.get_token()), Cancelled);
}

Frame shot_17(RigDevices& devices) {
  devices.turntable->move_to(40.0, {});
  devices.light_elevation->move_to(35.0, {});
  devices.point_light->switch_to(true, {});
  return devices.camera->shoot({.exposure_s = 0.02}, {}, 17);
}

TEST(SimulatedDevices, AShotIsTheSameShotAfterARestart) {
  RigDevices first = fresh_devices();
  first.ring_flash->switch_to(true, {});
  first.camera->shoot({.exposure_s = 0.02}, {}, 16);
  first.ring_flash->switch_to(false, {});
  const Frame before = shot_17(first);
  // Another process: a world built anew, and no history.
  const auto world = small_world();
  RigDevices second = make_simulated_devices(world->rig, world);
  const Frame after = shot_17(second);
  EXPECT_EQ(before.samples, after.samples);
  // Another key: the same picture with other noise.
  const Frame other = second.camera->shoot({.exposure_s = 0.02}, {}, 18);
  EXPECT_NE(after.samples, other.samples);
}

}  // namespace
}  // namespace lumitexel
