// A rendered session over the protocols is, byte for byte, the one of the same bench in process.
#include <gtest/gtest.h>

#include <map>

#include "rig/frame_file.h"
#include "rig/sequencer.h"
#include "rig/whole_file.h"
#include "sim/simulated_rig.h"
#include "tests/protocol/session/protocol_rig.h"
#include "tests/protocol/session/synthetic_shots.h"
#include "tests/unit/simulated_bench.h"

namespace lumitexel {
namespace {

// The small rendered bench with the quick rig's motions and, of its camera, what the protocol can say.
RigDescription rendered_rig(CameraKind camera) {
  const RigDescription quick = quick_rig(camera);
  RigDescription rig = small_bench();
  rig.turntable.speed_deg_per_s = rig.light_positioner.speed_deg_per_s = quick.turntable.speed_deg_per_s;
  rig.turntable.settle_s = rig.light_positioner.settle_s = quick.turntable.settle_s;
  CameraLimits& limits = rig.camera.limits;
  limits.readout_s = 0.001;
  limits.exposure_choices_s = quick.camera.limits.exposure_choices_s;
  limits.gain_min_db = quick.camera.limits.gain_min_db;
  limits.gain_max_db = quick.camera.limits.gain_max_db;
  limits.gain_step_db = quick.camera.limits.gain_step_db;
  return rig;
}

class SamePixels : public testing::TestWithParam<CameraKind> {
 protected:
  void SetUp() override {
    if (GetParam() == CameraKind::Still) offer_only_the_ptp_driver();
    rig_ = rendered_rig(GetParam());
    world_ = small_world(rig_);
    shots_ = synthetic_shots(4, rig_, 11, 2);
    // A few positions that show something, to the thousandth that registers hold.
    for (Shot& shot : shots_) {
      shot.turntable_deg = 10.5 * static_cast<double>(shot.id);
      shot.light_azimuth_deg = -20.0;
      shot.light_elevation_deg = 30.0;
    }
  }

  SessionStore new_session(const std::string& name) {
    SessionStore session = SessionStore::create(folder_ / name, SessionKind::Captured);
    session.put_shots(shots_);
    return session;
  }
  SessionStore in_process() {
    SessionStore session = new_session("in_process");
    RigDevices devices = make_simulated_devices(make_rendered_bench(rig_, world_, std::make_shared<VirtualClock>()));
    NoProgress nobody;
    take_missing_shots(session, devices, nobody, {});
    return session;
  }
  std::unique_ptr<ProtocolRig> served() {
    ProtocolRigOptions options;
    options.camera = GetParam();
    return std::make_unique<ProtocolRig>(options, rig_,
                                         make_rendered_bench(rig_, world_, std::make_shared<SystemClock>()));
  }

  // Of GigE frames the file, of camera raw files the samples in them.
  std::map<std::int64_t, std::string> frames_of(const SessionStore& session) const {
    std::map<std::int64_t, std::string> frames;
    for (const FrameRecord& record : session.frames()) {
      std::string bytes = read_whole_file(session.frame_path(record));
      if (GetParam() == CameraKind::Still) {
        const Frame frame = decode_frame_file(bytes, record.name);
        bytes.assign(reinterpret_cast<const char*>(frame.samples.data()), 2 * frame.samples.size());
      }
      frames[record.shot_id] = std::move(bytes);
    }
    return frames;
  }

  void expect_same(const SessionStore& a, const SessionStore& b) const {
    const auto of_a = frames_of(a), of_b = frames_of(b);
    ASSERT_EQ(of_a.size(), shots_.size());
    ASSERT_EQ(of_b.size(), shots_.size());
    for (const auto& [id, bytes] : of_a) EXPECT_TRUE(bytes == of_b.at(id)) << "shot " << id;
  }

  TemporaryFolder folder_;
  RigDescription rig_;
  std::shared_ptr<SimulatedWorld> world_;
  std::vector<Shot> shots_;
};
INSTANTIATE_TEST_SUITE_P(Camera, SamePixels, testing::Values(CameraKind::Gige, CameraKind::Still),
                         [](const auto& it) { return it.param == CameraKind::Gige ? "Gige" : "Still"; });

TEST_P(SamePixels, OverTheProtocolsAsInProcess) {
  const auto rig = served();
  SessionStore session = new_session("served");
  RigDevices devices = rig->connect();
  NoProgress nobody;
  take_missing_shots(session, devices, nobody, {});
  expect_same(in_process(), session);
}

TEST_P(SamePixels, AfterAResumeInMidSession) {
  SessionStore session = new_session("resumed");
  NoProgress nobody;
  {
    const auto rig = served();
    RigDevices devices = rig->connect();
    take_shots(session, devices, {shots_.begin(), shots_.begin() + 2}, nobody, {});
  }
  const auto rig = served();  // another day: everything has been off
  RigDevices devices = rig->connect();
  take_missing_shots(session, devices, nobody, {});
  expect_same(in_process(), session);
}

// That the comparison can fail.
TEST_P(SamePixels, ButNotUnderAnotherSeed) {
  SimulationSettings settings = plain_settings();
  settings.seed += 1;
  world_ = small_world(rig_, settings);
  { const SessionStore changed = in_process(); }
  world_ = small_world(rig_);
  std::filesystem::rename(folder_ / "in_process", folder_ / "other");
  const SessionStore moved = SessionStore::open(folder_ / "other", OpenMode::ReadOnly);
  EXPECT_FALSE(frames_of(moved) == frames_of(in_process()));
}

}  // namespace
}  // namespace lumitexel
