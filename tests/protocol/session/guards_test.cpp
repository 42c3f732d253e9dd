// Each guard against wrong frames in place, and taken out: with it every session over the protocols is right, without
// it the checker sees the very kind of error that it keeps away.
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "rig/sequencer.h"
#include "tests/protocol/session/attended_capture.h"
#include "tests/protocol/session/guardless_devices.h"
#include "tests/protocol/session/session_checker.h"
#include "tests/protocol/session/synthetic_shots.h"

namespace lumitexel {
namespace {

constexpr int kShots = 16;

// At every third operation where it is possible: the same however the threads run.
class EveryThird final : public FaultSource {
 public:
  EveryThird(Fault fault, std::uint64_t seed) : FaultSource(seed), fault_(fault) {}

 private:
  Fault choose(const std::string&, const std::string&, std::uint64_t, const std::vector<Fault>& possible) override {
    if (std::find(possible.begin(), possible.end(), fault_) == possible.end()) return Fault::None;
    return ++occasions_ % 3 == 0 ? fault_ : Fault::None;
  }
  Fault fault_;
  int occasions_ = 0;
};

std::shared_ptr<FaultSource> often(Fault fault, std::uint64_t seed) { return std::make_shared<EveryThird>(fault, seed); }

SessionCheck guarded(const ProtocolRigOptions& options) {
  const TemporaryFolder folder;
  ProtocolRig rig(options);
  SessionStore session = SessionStore::create(folder / "session", SessionKind::Captured);
  session.put_shots(synthetic_shots(kShots, rig.rig(), 3, 2));
  EXPECT_TRUE(capture_attended(rig, session).complete);
  return check_session(session);
}

// remove_guard is applied to the connected devices. A capture without guard runs through: nobody notices anything.
SessionCheck unguarded(const ProtocolRigOptions& options, const std::function<void(RigDevices&)>& remove_guard) {
  const TemporaryFolder folder;
  ProtocolRig rig(options);
  SessionStore session = SessionStore::create(folder / "session", SessionKind::Captured);
  session.put_shots(synthetic_shots(kShots, rig.rig(), 3, 2));
  RigDevices devices = rig.connect();
  remove_guard(devices);
  NoProgress nobody;
  take_missing_shots(session, devices, nobody, {});
  return check_session(session);
}

void credulous(RigDevices& devices) { devices.camera = without_guard(std::move(devices.camera)); }

TEST(Guards, KeepLateSettingsAway) {
  ProtocolRigOptions options;
  options.faults = often(Fault::LateSettings, 1);
  EXPECT_EQ(guarded(options).text(), "");
  options.faults = often(Fault::LateSettings, 1);
  const SessionCheck check = unguarded(options, credulous);
  EXPECT_GE(check.count(Wrong::Settings), 1);
  EXPECT_EQ(check.count(Wrong::Key), 0) << check.text();
}

// The chunks tell the registers while the frames are two settings behind: only the declared latency guards against it.
TEST(Guards, KeepFalseMetadataAway) {
  ProtocolRigOptions options;
  options.serving.gige.settings_latency_frames = options.declared_latency_frames = 2;
  options.serving.gige.metadata_from_registers = true;
  EXPECT_EQ(guarded(options).text(), "");
  options.declared_latency_frames = 0;
  const SessionCheck check = unguarded(options, [](RigDevices&) {});
  EXPECT_GE(check.count(Wrong::Record), 1) << "the journal believes the metadata";
  EXPECT_GE(check.count(Wrong::Settings), 1);
}

TEST(Guards, KeepStaleFramesAway) {
  ProtocolRigOptions options;
  options.serving.gige.timestamp_latch = false;  // else the driver itself sees that a frame is older than its trigger
  options.faults = often(Fault::StaleFrame, 2);
  EXPECT_EQ(guarded(options).text(), "");
  options.faults = often(Fault::StaleFrame, 2);
  const SessionCheck check = unguarded(options, credulous);
  EXPECT_GE(check.count(Wrong::Key), 1);
  EXPECT_GE(check.duplicated(), 1);
}

// Without names in the frames (and so without keys in the strips) there are still the camera's count and its time.
TEST(Guards, KeepStaleFramesAwayWithoutNames) {
  ProtocolRigOptions options;
  options.frames_named = false;
  options.serving.gige.timestamp_latch = false;
  options.faults = often(Fault::StaleFrame, 2);
  const SessionCheck check = guarded(options);
  EXPECT_EQ(check.duplicated(), 0) << check.text();
  EXPECT_EQ(check.count(Wrong::Settings), 0) << check.text();
  EXPECT_EQ(check.count(Wrong::Position), 0) << check.text();
}

TEST(Guards, KeepWrongPositionsAway) {
  ProtocolRigOptions options;
  options.speed_deg_per_s = 1500.0;
  EXPECT_EQ(guarded(options).text(), "");
  const SessionCheck check = unguarded(options, [](RigDevices& devices) {
    devices.light_azimuth = without_guard(std::move(devices.light_azimuth), devices.clock);
    devices.light_elevation = without_guard(std::move(devices.light_elevation), devices.clock);
    devices.turntable = without_guard(std::move(devices.turntable), devices.clock);
  });
  EXPECT_GE(check.count(Wrong::Position), 1);
  EXPECT_EQ(check.count(Wrong::Settings), 0) << check.text();
}

TEST(Guards, KeepDarkLampsAway) {
  ProtocolRigOptions options;
  options.faults = often(Fault::LampFails, 5);
  EXPECT_EQ(guarded(options).text(), "");
  options.faults = often(Fault::LampFails, 5);
  const SessionCheck check = unguarded(options, [](RigDevices& devices) {
    for (auto* lamp : {&devices.point_light, &devices.ring_flash, &devices.backlight}) {
      *lamp = without_guard(std::move(*lamp), devices.clock);
    }
  });
  EXPECT_GE(check.count(Wrong::Lamps), 1);
  EXPECT_EQ(check.count(Wrong::Settings), 0) << check.text();
}

TEST(Guards, AStoppedSessionLacksItsLastShots) {
  const TemporaryFolder folder;
  ProtocolRig rig({});
  SessionStore session = SessionStore::create(folder / "session", SessionKind::Captured);
  const std::vector<Shot> shots = synthetic_shots(6, rig.rig(), 3);
  session.put_shots(shots);
  RigDevices devices = rig.connect();
  NoProgress nobody;
  take_shots(session, devices, {shots.begin(), shots.begin() + 4}, nobody, {});
  EXPECT_EQ(check_session(session).lost(), 2);
  take_missing_shots(session, devices, nobody, {});
  EXPECT_EQ(check_session(session).text(), "");
}

}  // namespace
}  // namespace lumitexel
