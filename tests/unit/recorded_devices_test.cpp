#include "rig/recorded_devices.h"

#include <gtest/gtest.h>

#include "drivers/error.h"
#include "rig/lighting.h"
#include "rig/raw_frame_file.h"
#include "rig/whole_file.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/recorded_session.h"
#include "tests/unit/small_rig.h"

namespace lumitexel {
namespace {

class RecordedDevices : public testing::Test {
 protected:
  void SetUp() override {
    recorded_.capture({[](int trigger) {
                         if (trigger == 5) throw Timeout("fake camera: late");
                       },
                       {}});
    recording_ = recorded_.open();
    frames_ = recording_->frames();
    shots_ = recording_->shots();
    devices_ = make_recorded_devices(recording_, recorded_frames(*recording_));
  }
  void stand_and_light(const Shot& shot) {
    devices_.turntable->move_to(shot.turntable_deg, {});
    devices_.light_azimuth->move_to(shot.light_azimuth_deg, {});
    devices_.light_elevation->move_to(shot.light_elevation_deg, {});
    const Lighting lighting = lighting_of(shot.kind);
    devices_.point_light->switch_to(lighting.point, {});
    devices_.ring_flash->switch_to(lighting.ring, {});
    devices_.backlight->switch_to(lighting.back, {});
  }
  std::vector<std::uint16_t> samples_of(const FrameRecord& frame) const {
    return decode_pgm(read_whole_file(recording_->frame_path(frame)), frame.name).samples;
  }

  RecordedSession recorded_;
  std::shared_ptr<const SessionStore> recording_;
  std::vector<FrameRecord> frames_;
  std::vector<Shot> shots_;
  RigDevices devices_;
};

TEST_F(RecordedDevices, DeliverTheFrameThatWasTakenSo) {
  for (const std::size_t i : {0u, 3u, 26u}) {
    stand_and_light(shots_[i]);
    const Frame frame = devices_.camera->shoot(shots_[i].camera, {}, static_cast<std::uint64_t>(shots_[i].id));
    EXPECT_EQ(frame.samples, samples_of(frames_[i]));
    EXPECT_EQ(frame.reported, frames_[i].reported);
    EXPECT_EQ(frame.device_time_s, frames_[i].device_time_s);
    EXPECT_EQ(frame.sensor_temperature_c, frames_[i].sensor_temperature_c);
    EXPECT_EQ(devices_.clock->utc_ns(), frames_[i].utc_ns);
    EXPECT_EQ(devices_.light_azimuth->position(), frames_[i].light_azimuth_deg);
  }
}

TEST_F(RecordedDevices, TellAlikeShotsApartByTheirNameElseTakeTheFirst) {
  const Shot& dark = shots_[25];
  ASSERT_EQ(dark.camera, shots_[26].camera);
  stand_and_light(dark);
  EXPECT_EQ(devices_.camera->shoot(dark.camera, {}, 4711).samples, samples_of(frames_[25]));
  EXPECT_EQ(devices_.camera->shoot(dark.camera, {}, 4712).samples, samples_of(frames_[26]));
}

TEST_F(RecordedDevices, RefuseWhatWasNotRecorded) {
  const Shot& shot = shots_[3];
  const auto refused = [&](const char* part, const CameraSettings& settings) {
    try {
      devices_.camera->shoot(settings, {}, static_cast<std::uint64_t>(shot.id));
      ADD_FAILURE() << "delivered";
    } catch (const OutOfRange& error) {
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
      EXPECT_NE(std::string(error.what()).find(recorded_.path().string()), std::string::npos) << error.what();
    }
  };
  stand_and_light(shot);
  refused("0.5 s", {0.5, 0.0});
  devices_.ring_flash->switch_to(true, {});
  refused("point lightring flash", shot.camera);
  devices_.ring_flash->switch_to(false, {});
  devices_.turntable->move_to(shot.turntable_deg + 0.1, {});
  refused("turntable", shot.camera);
  devices_.turntable->move_to(shot.turntable_deg, {});
  EXPECT_NO_THROW(devices_.camera->shoot(shot.camera, {}, static_cast<std::uint64_t>(shot.id)));
  refused("no (more) frame", shot.camera);  // each once
}

TEST_F(RecordedDevices, RepeatAFailedAttemptBeforeTheFrame) {
  std::vector<DiscardedFrame> discards;
  devices_.camera->on_discard([&](const DiscardedFrame& frame) { discards.push_back(frame); });
  stand_and_light(shots_[4]);
  EXPECT_EQ(devices_.camera->shoot(shots_[4].camera, {}, 5).samples, samples_of(frames_[4]));
  ASSERT_EQ(discards.size(), 1u);
  EXPECT_EQ(discards[0].cause, "fake camera: late");
  EXPECT_EQ(discards[0].frame_key, 5u);
}

TEST_F(RecordedDevices, TakeNoTime) {
  const double start_s = devices_.clock->now_s();
  stand_and_light(shots_[4]);
  EXPECT_LT(devices_.clock->now_s() - start_s, 1e-3);
}

TEST_F(RecordedDevices, AreNotOfAnImportedSession) {
  { SessionStore::create(recorded_ / "imported", SessionKind::Imported); }
  const auto imported =
      std::make_shared<const SessionStore>(SessionStore::open(recorded_ / "imported", OpenMode::ReadOnly));
  EXPECT_BAD_INPUT(make_recorded_devices(imported, {}), "imported", "capture");
}

}  // namespace
}  // namespace lumitexel
