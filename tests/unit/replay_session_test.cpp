#include "rig/replay_session.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "drivers/error.h"
#include "rig/capture_plan.h"
#include "rig/schedule.h"
#include "rig/sqlite_database.h"
#include "rig/verify_session.h"
#include "rig/whole_file.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/recorded_session.h"
#include "tests/unit/small_rig.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

class ReplaySession : public testing::Test {
 protected:
  ViewSelection select(const SelectionOptions& options = {}) const {
    return select_views(planned_views(*recorded_.open()), options);
  }
  ReplaySummary replay(const ViewSelection& selection, const std::string& name = "replay") {
    const auto recording = recorded_.open();
    SessionStore session = begin_replay(*recording, selection, recorded_ / name);
    NoProgress progress;
    return play_missing_shots(recording, session, progress, {});
  }
  SessionStore opened(const std::string& name = "replay") const {
    return SessionStore::open(recorded_ / name, OpenMode::ReadOnly);
  }
  void expect_same_journal() const {
    EXPECT_EQ(frame_lines(opened()), frame_lines(*recorded_.open()));
    EXPECT_EQ(discard_lines(opened()), discard_lines(*recorded_.open()));
    EXPECT_EQ(opened().content_sha256(), recorded_.open()->content_sha256());
  }

  RecordedSession recorded_;
};

TEST_F(ReplaySession, OfEverythingIsTheRecordingBitForBit) {
  recorded_.capture();
  const ReplaySummary summary = replay(select());
  EXPECT_EQ(summary.frames, 27);
  EXPECT_EQ(summary.discards, 0);
  EXPECT_TRUE(left_out_of(*recorded_.open(), opened()).empty());
  const std::vector<FrameRecord> frames = recorded_.open()->frames();
  EXPECT_NE(frames[3].light_azimuth_deg, 20.0);  // else the readings would prove nothing
  EXPECT_NEAR(summary.seconds, 1e-9 * static_cast<double>(frames.back().utc_ns - frames.front().utc_ns), 1e-3);
  expect_same_journal();
  for (const FrameRecord& frame : frames) {
    EXPECT_EQ(read_whole_file(opened().frame_path(frame)), read_whole_file(recorded_.open()->frame_path(frame)));
  }
  EXPECT_EQ(opened().document("plan.toml"), small_plan_toml());
  EXPECT_TRUE(fs::exists(recorded_ / "replay" / "truth" / "calibration.json"));
  NoProgress progress;
  EXPECT_TRUE(verify_session(opened(), progress).ok());
}

TEST_F(ReplaySession, RepeatsWhatWasDiscardedAndWhy) {
  recorded_.capture({[](int trigger) {
                       if (trigger == 11) throw Timeout("fake camera: no frame within 3 s");
                       if (trigger == 13) throw Disconnected("fake camera: unplugged");
                     },
                     [](int trigger, Frame& frame) {
                       if (trigger == 3) frame.reported.exposure_s *= 2;
                       if (trigger == 5 || trigger == 6) frame.echoed_key = 2;
                       if (trigger == 8 || trigger == 9) frame.device_frame_id = 1000;  // one frame twice
                       if (trigger == 20) frame.reported.gain_db += 3;
                     }});
  ASSERT_EQ(recorded_.open()->discards().size(), 7u);
  EXPECT_TRUE(recorded_.open()->missing_shots().empty());
  EXPECT_EQ(replay(select()).discards, 7);
  EXPECT_EQ(frame_lines(opened()), frame_lines(*recorded_.open()));
  std::vector<DiscardRecord> discards = recorded_.open()->discards(), again = opened().discards();
  ASSERT_EQ(again.size(), discards.size());
  for (std::size_t i = 0; i < discards.size(); ++i) {
    EXPECT_EQ(again[i].shot_id, discards[i].shot_id);
    EXPECT_EQ(again[i].attempt, discards[i].attempt);
    EXPECT_EQ(again[i].asked, discards[i].asked);
    EXPECT_EQ(again[i].cause, discards[i].cause);
    EXPECT_EQ(again[i].utc_ns, discards[i].utc_ns);
    // A frame that came twice cannot be made up safely: it is a failed attempt in the replay.
    const bool repeated = discards[i].cause.find("delivered before") != std::string::npos;
    EXPECT_EQ(again[i].reported, repeated ? std::nullopt : discards[i].reported) << discards[i].cause;
  }
}

TEST_F(ReplaySession, FollowsARecordingThroughFaultsThatEndedIt) {
  recorded_.capture({[](int trigger) {
                       if (trigger >= 5) throw Timeout("fake camera: wedged");
                     },
                     {}});
  recorded_.capture({{}, [](int trigger, Frame& frame) {
                       if (trigger >= 8) frame.reported.exposure_s *= 3;
                     }});
  recorded_.capture();  // the camera's clock has begun anew each time
  EXPECT_EQ(recorded_.open()->discards().size(), 6u);
  EXPECT_TRUE(recorded_.open()->missing_shots().empty());
  EXPECT_EQ(replay(select()).discards, 6);
  expect_same_journal();
}

TEST_F(ReplaySession, FollowsARecordingThroughAStopAndALaterResume) {
  recorded_.capture({[](int trigger) {
                       if (trigger == 7) throw Cancelled("fake camera: told to stop");
                     },
                     {}});
  recorded_.capture();
  const std::vector<FrameRecord> frames = recorded_.open()->frames();
  ASSERT_EQ(frames.size(), 27u);
  ASSERT_LT(frames[6].device_time_s, frames[5].device_time_s);  // the camera's clock has begun anew
  ASSERT_TRUE(recorded_.open()->discards().empty());
  replay(select());
  expect_same_journal();
}

// Twice the same shot: stopped amid its attempts, tried again later.
TEST_F(ReplaySession, CountsTheAttemptsOfEveryRunAnew) {
  recorded_.capture({[](int trigger) {
                       if (trigger == 4) throw Timeout("fake camera: late");
                       if (trigger == 5) throw Cancelled("fake camera: told to stop");
                     },
                     {}});
  recorded_.capture({[](int trigger) {
                       if (trigger == 1) throw Timeout("fake camera: late again");
                     },
                     {}});
  const std::vector<DiscardRecord> discards = recorded_.open()->discards();
  ASSERT_EQ(discards.size(), 2u);
  EXPECT_EQ(discards[0].shot_id, discards[1].shot_id);
  EXPECT_EQ(discards[1].attempt, 1);
  replay(select());
  expect_same_journal();
}

TEST_F(ReplaySession, WhatTheRecordingLacksStaysMissing) {
  recorded_.capture({[](int trigger) {
                       if (trigger >= 20) throw Timeout("fake camera: wedged");
                     },
                     {}});
  ASSERT_EQ(recorded_.open()->frames().size(), 19u);
  fs::remove(recorded_.path() / "frames" / "000004_object.pgm");
  SqliteDatabase(recorded_.path() / "session.db", DatabaseMode::ReadWrite).run("DELETE FROM frames WHERE shot_id = 4");
  EXPECT_EQ(replay(select()).frames, 18);
  const std::vector<Shot> missing = opened().missing_shots();
  ASSERT_EQ(missing.size(), 9u);
  EXPECT_EQ(missing[0].id, 4);
  EXPECT_EQ(missing[1].id, 20);
  // Its frames' numbers in the journal are others now.
  EXPECT_EQ(opened().content_sha256(), recorded_.open()->content_sha256());
  EXPECT_EQ(discard_lines(opened()), discard_lines(*recorded_.open()));
}

TEST_F(ReplaySession, WithoutAViewKeepsTheOthersShotsAsTheyWere) {
  recorded_.capture();
  replay(select({{"view=1"}, {}}));
  const SessionStore shorter = opened();
  const CapturePlan plan = parse_plan(shorter.document("plan.toml"), "plan.toml");
  CapturePlan expected = small_plan();
  expected.views.erase(expected.views.begin() + 1);
  EXPECT_EQ(plan, expected);
  EXPECT_EQ(left_out_of(*recorded_.open(), shorter), std::vector<std::string>{"fit_001"});
  EXPECT_EQ(shorter.shots().size(), 27u - 5u);
  EXPECT_EQ(shorter.frames().size(), 22u);
  std::vector<std::string> kept;
  for (const FrameRecord& frame : recorded_.open()->frames()) kept.push_back(frame.name + frame.sha256);
  for (const FrameRecord& frame : shorter.frames()) {
    EXPECT_THAT(kept, testing::Contains(frame.name + frame.sha256));
  }
  NoProgress progress;
  EXPECT_TRUE(verify_session(shorter, progress).ok());
  replay(select({{"view=1"}, {}}), "again");
  EXPECT_EQ(opened("again").content_sha256(), shorter.content_sha256());
}

TEST_F(ReplaySession, WithoutAKindKeepsThePlan) {
  recorded_.capture();
  replay(select({{"kind=dark"}, {}}));
  EXPECT_EQ(opened().document("plan.toml"), small_plan_toml());
  EXPECT_EQ(left_out_of(*recorded_.open(), opened()), std::vector<std::string>{"kind=dark"});
  for (const Shot& shot : opened().shots()) EXPECT_NE(shot.kind, ShotKind::Dark);
  EXPECT_TRUE(opened().missing_shots().empty());
}

TEST_F(ReplaySession, GoesOnAfterAStopWithoutDoingAnythingTwice) {
  recorded_.capture({[](int trigger) {
                       if (trigger == 4 || trigger == 15) throw Timeout("fake camera: late");
                     },
                     {}});
  const auto recording = recorded_.open();
  class StopAt final : public Progress {
   public:
    StopAt(std::stop_source stop, std::int64_t at) : stop_(std::move(stop)), at_(at) {}
    void begin(const std::string&, std::int64_t, const std::string&) override {}
    void update(std::int64_t done) override {
      if (done == at_) stop_.request_stop();
    }

   private:
    std::stop_source stop_;
    std::int64_t at_;
  };
  std::stop_source stop;
  StopAt progress(stop, 10);
  {
    SessionStore session = begin_replay(*recording, select(), recorded_ / "replay");
    EXPECT_THROW(play_missing_shots(recording, session, progress, stop.get_token()), Cancelled);
    EXPECT_EQ(session.frames().size(), 10u);
  }
  {
    SessionStore session = SessionStore::open(recorded_ / "replay", OpenMode::ReadWrite);
    const auto source = recording_of(session);
    ASSERT_NE(source, nullptr);
    EXPECT_EQ(play_missing_shots(source, session, progress, {}).frames, 17);
  }
  expect_same_journal();
}

TEST_F(ReplaySession, KilledAmidAShotItDoesNotRepeatWhatItHasDiscarded) {
  recorded_.capture({[](int trigger) {
                       if (trigger == 27) throw Timeout("fake camera: late");
                     },
                     {}});
  replay(select());
  SqliteDatabase(recorded_ / "replay" / "session.db", DatabaseMode::ReadWrite)
      .run("DELETE FROM frames WHERE shot_id = 27");
  {
    SessionStore session = SessionStore::open(recorded_ / "replay", OpenMode::ReadWrite);
    NoProgress progress;
    EXPECT_EQ(play_missing_shots(recorded_.open(), session, progress, {}).frames, 1);
  }
  EXPECT_EQ(discard_lines(opened()), discard_lines(*recorded_.open()));
  EXPECT_EQ(opened().content_sha256(), recorded_.open()->content_sha256());
}

TEST_F(ReplaySession, AFaultThatWasNotRecordedStopsIt) {
  recorded_.capture({[](int trigger) {
                       if (trigger >= 20) throw Timeout("fake camera: wedged");
                     },
                     {}});
  // A reading that no sequencer lets pass: the replay may not take it for the end that was recorded.
  SqliteDatabase(recorded_.path() / "session.db", DatabaseMode::ReadWrite)
      .run("UPDATE frames SET light_azimuth_deg = light_azimuth_deg + 3 WHERE shot_id = 4");
  EXPECT_THROW(replay(select()), Protocol);
  EXPECT_EQ(opened().frames().size(), 3u);
}

TEST_F(ReplaySession, ADamagedRecordedFrameIsNotPlayed) {
  recorded_.capture();
  const fs::path file = recorded_.path() / "frames" / "000004_object.pgm";
  std::string bytes = read_whole_file(file);
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  write_whole_file(file, bytes);
  EXPECT_THROW(replay(select()), Corrupt);
  EXPECT_EQ(opened().frames().size(), 3u);
}

TEST_F(ReplaySession, KnowsItsRecordingAgainOrSaysWhyNot) {
  recorded_.capture();
  replay(select());
  EXPECT_EQ(recording_of(*recorded_.open()), nullptr);
  SqliteDatabase(recorded_.path() / "session.db", DatabaseMode::ReadWrite).run("DELETE FROM frames WHERE shot_id = 4");
  EXPECT_BAD_INPUT(recording_of(opened()), "replay: a replay of " + recorded_.path().string(), "changed");
  fs::rename(recorded_.path(), recorded_ / "moved");
  EXPECT_BAD_INPUT(recording_of(opened()), "replay: a replay of " + recorded_.path().string(), "no session there");
}

}  // namespace
}  // namespace lumitexel
