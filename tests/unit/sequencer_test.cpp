#include "rig/sequencer.h"

#include <gtest/gtest.h>

#include <set>

#include "drivers/error.h"
#include "rig/capture_estimate.h"
#include "rig/new_session.h"
#include "rig/raw_frame_file.h"
#include "rig/schedule.h"
#include "rig/whole_file.h"
#include "tests/unit/fake_rig.h"
#include "tests/unit/small_rig.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

class SequencerTest : public testing::Test {
 protected:
  SequenceSummary run() {
    NoProgress progress;
    return take_missing_shots(store_, devices_, progress, stop_.get_token());
  }
  void expect_dark_and_still() const {
    EXPECT_FALSE(bench_->point_light || bench_->ring_flash || bench_->backlight);
    EXPECT_EQ(bench_->forced_off, 3);
    EXPECT_EQ(bench_->halts, 3);
  }
  bool logged(const std::string& level, const std::string& part) const {
    for (const SessionEvent& event : store_.events()) {
      if (event.level == level && event.text.find(part) != std::string::npos) return true;
    }
    return false;
  }

  TemporaryFolder folder_;
  RigDescription rig_ = small_rig();
  std::vector<Shot> shots_ = schedule_shots(small_plan(), rig_, "plan.toml");
  SessionStore store_ = begin_session(folder_ / "s", {{{"rig.toml", small_rig_toml()}}, shots_, nullptr});
  std::shared_ptr<FakeBench> bench_ = std::make_shared<FakeBench>();
  RigDevices devices_ = make_fake_devices(rig_, bench_);
  std::stop_source stop_;
};

TEST_F(SequencerTest, TakesEveryShotUnderItsOwnLightAndSettings) {
  std::vector<std::vector<bool>> lamps;
  bench_->before_exposure = [&] { lamps.push_back({bench_->backlight, bench_->ring_flash, bench_->point_light}); };
  EXPECT_EQ(run().shots, static_cast<std::int64_t>(shots_.size()));
  const std::vector<FrameRecord> frames = store_.frames();
  ASSERT_EQ(frames.size(), shots_.size());
  for (std::size_t i = 0; i < shots_.size(); ++i) {
    const Shot& shot = shots_[i];
    EXPECT_EQ(frames[i].shot_id, shot.id);
    EXPECT_EQ(frames[i].requested, shot.camera);
    EXPECT_EQ(frames[i].applied, shot.camera);
    EXPECT_EQ(frames[i].reported, shot.camera);
    EXPECT_EQ(frames[i].turntable_deg, shot.turntable_deg);
    EXPECT_EQ(frames[i].light_azimuth_deg, shot.light_azimuth_deg);
    EXPECT_EQ(frames[i].light_elevation_deg, shot.light_elevation_deg);
    const bool point = shot.kind == ShotKind::SpheresPoint || shot.kind == ShotKind::Object || shot.kind == ShotKind::GrayCard;
    EXPECT_EQ(lamps[i], (std::vector<bool>{shot.kind == ShotKind::Silhouette, shot.kind == ShotKind::SpheresRing, point}));
  }
  EXPECT_TRUE(store_.missing_shots().empty());
  expect_dark_and_still();
  EXPECT_TRUE(logged("info", "27 shots taken"));
}

// Two darks of one exposure differ in nothing but the shot that they are for.
TEST_F(SequencerTest, NamesEveryFrameToTheCameraByItsShot) {
  std::set<std::uint64_t> keys;
  bench_->tamper = [&](Frame& frame) { keys.insert(frame.samples[0] * 65536u + frame.samples[1]); };
  run();
  EXPECT_EQ(keys.size(), shots_.size());
}

TEST_F(SequencerTest, NeitherMovesNorSwitchesWithoutNeed) {
  run();
  // Three views in a row: three axes at first, then the turntable alone, then all three; the card and the darks none.
  EXPECT_EQ(bench_->moves, 3 + 1 + 3);
  // Each view: backlight on; off, ring on; off, point on; and off again before the next or the darks.
  EXPECT_EQ(bench_->switches, 3 * 6);
}

TEST_F(SequencerTest, TakesTheTimeThatWasEstimated) {
  EXPECT_NEAR(run().seconds, estimate_capture(shots_, rig_).estimate_s, 1e-9);
}

TEST_F(SequencerTest, ASecondRunHasNothingToDo) {
  run();
  const int frames = bench_->frames;
  EXPECT_EQ(run().shots, 0);
  EXPECT_EQ(bench_->frames, frames);
}

TEST_F(SequencerTest, AFrameWithOtherSettingsIsDiscardedAndShotAgain) {
  bench_->tamper = [&](Frame& frame) {
    if (bench_->frames != 5) return;
    frame.reported.exposure_s *= 2;  // late settings: the previous shot's, say
    frame.samples.assign(frame.samples.size(), 0);
  };
  run();
  EXPECT_EQ(bench_->frames, static_cast<int>(shots_.size()) + 1);
  const FrameRecord record = store_.frames()[4];
  EXPECT_EQ(record.reported, shots_[4].camera);
  const Frame frame = decode_pgm(read_whole_file(store_.frame_path(record)), record.name);
  EXPECT_NE(frame.samples, std::vector<std::uint16_t>(24, 0));
}

TEST_F(SequencerTest, EveryAttemptThatCameToNothingIsInTheJournal) {
  bench_->before_exposure = [&] {
    if (bench_->frames == 6) ++bench_->frames, throw Timeout("fake camera: late");
    if (bench_->frames >= 9) throw Disconnected("fake camera: unplugged");
  };
  bench_->tamper = [&](Frame& frame) {
    if (bench_->frames == 3) frame.reported.exposure_s *= 2;
  };
  EXPECT_THROW(run(), Disconnected);
  const std::vector<DiscardRecord> discards = store_.discards();
  ASSERT_EQ(discards.size(), 5u);
  EXPECT_EQ(discards[0].shot_id, 3);
  EXPECT_EQ(discards[0].asked, shots_[2].camera);
  EXPECT_EQ(discards[0].reported, (CameraSettings{2 * shots_[2].camera.exposure_s, shots_[2].camera.gain_db}));
  EXPECT_EQ(discards[1].shot_id, 6);
  EXPECT_EQ(discards[1].cause, "fake camera: late");
  EXPECT_EQ(discards[1].reported, std::nullopt);
  for (int attempt = 1; attempt <= 3; ++attempt) {  // the last one, too, that ended the run
    EXPECT_EQ(discards[static_cast<std::size_t>(attempt) + 1].shot_id, 8);
    EXPECT_EQ(discards[static_cast<std::size_t>(attempt) + 1].attempt, attempt);
  }
}

TEST_F(SequencerTest, ACameraThatAlwaysReportsOtherSettingsIsAtFault) {
  bench_->tamper = [](Frame& frame) { frame.reported.gain_db += 1; };
  EXPECT_THROW(run(), Protocol);
  EXPECT_EQ(bench_->frames, 3);
  EXPECT_TRUE(store_.frames().empty());
  expect_dark_and_still();
  EXPECT_TRUE(logged("error", "the frame reports"));
}

TEST_F(SequencerTest, AFrameOfAnotherSizeIsAtFault) {
  bench_->tamper = [](Frame& frame) { std::swap(frame.width_px, frame.height_px); };
  EXPECT_THROW(run(), Protocol);
  EXPECT_TRUE(store_.frames().empty());
}

TEST_F(SequencerTest, AnAxisThatStandsElsewhereIsAtFault) {
  for (const double slip_deg : {1.0, std::nan("")}) {
    bench_->before_exposure = [&] { bench_->light_azimuth_deg += slip_deg; };
    EXPECT_THROW(run(), Protocol);
    EXPECT_TRUE(store_.frames().empty());
  }
}

TEST_F(SequencerTest, ACancelLeavesTheRigDarkAndTheRestToResume) {
  bench_->before_exposure = [&] {
    if (bench_->frames == 9) stop_.request_stop();
  };
  EXPECT_THROW(run(), Cancelled);
  EXPECT_EQ(store_.frames().size(), 9u);
  expect_dark_and_still();
  bench_->before_exposure = nullptr;
  stop_ = std::stop_source();
  EXPECT_EQ(run().shots, static_cast<std::int64_t>(shots_.size()) - 9);
}

TEST_F(SequencerTest, AFaultLeavesTheRigDarkAndIsLogged) {
  bench_->before_exposure = [&] {
    if (bench_->frames == 4) throw Disconnected("fake camera: unplugged");
  };
  EXPECT_THROW(run(), Disconnected);
  expect_dark_and_still();
  EXPECT_TRUE(logged("error", "unplugged"));
}

}  // namespace
}  // namespace lumitexel
