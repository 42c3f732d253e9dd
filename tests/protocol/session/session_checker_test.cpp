// The checker on sessions that were written wrong on purpose, each in one way.
#include "tests/protocol/session/session_checker.h"

#include <gtest/gtest.h>

#include <functional>

#include "rig/frame_file.h"
#include "rig/lighting.h"
#include "rig/whole_file.h"
#include "sim/state_strip.h"
#include "tests/protocol/session/protocol_rig.h"
#include "tests/protocol/session/synthetic_shots.h"

namespace lumitexel {
namespace {

// What is about to be stored as the frame of a shot.
struct Forged {
  StateStrip strip;
  NewFrame record;
  bool with_strip = true, stored = true;
};
using Forge = std::function<void(Forged&)>;

class SessionChecker : public testing::Test {
 protected:
  // Six frames, right but for what `forge` does to the third.
  SessionCheck check_with(const Forge& forge) {
    const RigDescription rig = quick_rig(CameraKind::Gige);
    SessionStore session = SessionStore::create(folder_ / "session", SessionKind::Captured);
    const std::vector<Shot> shots = synthetic_shots(6, rig, 7);
    session.put_shots(shots);
    for (const Shot& shot : shots) {
      Forged forged = right_frame(shot);
      if (shot.id == 3) forge(forged);
      if (forged.stored) store(session, rig.camera.limits, forged);
    }
    return check_session(session);
  }

  static Forged right_frame(const Shot& shot) {
    const Lighting lit = lighting_of(shot.kind);
    Forged forged;
    forged.strip = {shot.camera,
                    {shot.turntable_deg, shot.light_azimuth_deg, shot.light_elevation_deg, lit.point, lit.ring,
                     lit.back},
                    static_cast<std::uint64_t>(shot.id),
                    static_cast<std::uint64_t>(10 + shot.id)};
    NewFrame& record = forged.record;
    record.shot_id = shot.id;
    record.name = frame_file_name(shot);
    record.role = to_string(shot.kind);
    record.requested = record.applied = record.reported = shot.camera;
    record.turntable_deg = shot.turntable_deg;
    record.light_azimuth_deg = shot.light_azimuth_deg;
    record.light_elevation_deg = shot.light_elevation_deg;
    return forged;
  }

  static void store(SessionStore& session, const CameraLimits& limits, const Forged& forged) {
    Frame frame;
    frame.width_px = limits.width_px;
    frame.height_px = limits.height_px;
    frame.bits = limits.bits;
    frame.samples.assign(static_cast<std::size_t>(limits.width_px * limits.height_px), 100);
    if (forged.with_strip) write_state_strip(forged.strip, frame.bits, frame.samples);
    session.commit_frame(forged.record, stored_bytes(frame));
  }

  // Nothing but that kind, of shot 3.
  void expect_only(Wrong how, const Forge& forge) {
    const SessionCheck check = check_with(forge);
    EXPECT_GE(check.count(how), 1) << check.text();
    for (const WrongFrame& wrong : check.wrong) {
      EXPECT_EQ(wrong.how, how) << wrong.text;
      EXPECT_EQ(wrong.shot_id, 3) << wrong.text;
    }
    const bool has_label = how != Wrong::Lost && how != Wrong::Duplicated;
    EXPECT_EQ(check.mislabelled(), has_label ? 1 : 0);
  }

  TemporaryFolder folder_;
};

TEST_F(SessionChecker, FindsNothingWrongWithARightSession) {
  const SessionCheck check = check_with([](Forged&) {});
  EXPECT_EQ(check.shots, 6);
  EXPECT_EQ(check.frames, 6);
  EXPECT_TRUE(check.wrong.empty()) << check.text();
}

TEST_F(SessionChecker, SeesLateSettings) {
  expect_only(Wrong::Settings, [](Forged& forged) {
    forged.strip.settings.exposure_s += 1e-6;
    forged.record.applied = forged.record.reported = forged.strip.settings;
  });
}

TEST_F(SessionChecker, SeesAnotherGain) {
  expect_only(Wrong::Settings, [](Forged& forged) {
    forged.strip.settings.gain_db += 0.5;
    forged.record.applied = forged.record.reported = forged.strip.settings;
  });
}

TEST_F(SessionChecker, SeesFalseMetadata) {
  expect_only(Wrong::Record, [](Forged& forged) { forged.record.reported.exposure_s *= 1.5; });
}

TEST_F(SessionChecker, SeesAWrongPosition) {
  expect_only(Wrong::Position, [](Forged& forged) {
    forged.strip.state.light_elevation_deg += 0.05;
    forged.record.light_elevation_deg += 0.05;
  });
}

TEST_F(SessionChecker, SeesAPositionThatTheJournalHasOtherwise) {
  expect_only(Wrong::Record, [](Forged& forged) { forged.record.turntable_deg += 0.005; });
}

TEST_F(SessionChecker, SeesPositionsThatAreNoNumbers) {
  expect_only(Wrong::Record, [](Forged& forged) { forged.record.turntable_deg = 1.0 / 0.0; });
}

TEST_F(SessionChecker, SeesADarkLampAndOneTooMany) {
  expect_only(Wrong::Lamps, [](Forged& forged) { forged.strip.state.point_light = false; });
}

TEST_F(SessionChecker, SeesALampTooMany) {
  expect_only(Wrong::Lamps, [](Forged& forged) { forged.strip.state.ring_flash = true; });
}

TEST_F(SessionChecker, SeesTheFrameOfAnotherShot) {
  expect_only(Wrong::Key, [](Forged& forged) { forged.strip.frame_key = 2; });
}

TEST_F(SessionChecker, SeesAnExposureInTwoFrames) {
  expect_only(Wrong::Duplicated, [](Forged& forged) { forged.strip.exposure_count = 12; });
}

TEST_F(SessionChecker, SeesAShotWithoutAFrame) {
  expect_only(Wrong::Lost, [](Forged& forged) { forged.stored = false; });
}

TEST_F(SessionChecker, SeesPixelsThatSayNothing) {
  expect_only(Wrong::Unreadable, [](Forged& forged) { forged.with_strip = false; });
}

TEST_F(SessionChecker, SeesAFileThatHasChanged) {
  check_with([](Forged&) {});
  const SessionStore session = SessionStore::open(folder_ / "session", OpenMode::ReadOnly);
  const std::filesystem::path file = session.frame_path(session.frames().at(2));
  std::string bytes = read_whole_file(file);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  std::filesystem::permissions(file, std::filesystem::perms::owner_write, std::filesystem::perm_options::add);
  write_whole_file(file, bytes);
  const SessionCheck check = check_session(session);
  EXPECT_EQ(check.count(Wrong::Unreadable), 1) << check.text();
}

}  // namespace
}  // namespace lumitexel
