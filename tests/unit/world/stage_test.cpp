// Who puts the board before the camera: a stage hand, an operator who is asked, a recording.
#include <gtest/gtest.h>

#include "drivers/error.h"
#include "rig/new_session.h"
#include "rig/recorded_devices.h"
#include "rig/recording.h"
#include "rig/schedule.h"
#include "rig/sequencer.h"
#include "rig/stage.h"
#include "tests/unit/fake_rig.h"
#include "tests/unit/small_rig.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

constexpr const char* kBoard =
    "\n[board]\npattern = \"checkerboard\"\ncolumns = 5\nrows = 4\npitch_m = 0.02\nalbedo = 0.8\n";
constexpr const char* kLens =
    "\n[lens]\nboard_s = 0.01\nboard_placements = 2\nflat_field_s = [0.02]\nflat_field_frames = 3\n";

class RecordingHand final : public StageHand {
 public:
  explicit RecordingHand(std::vector<std::string>& placed) : placed_(placed) {}
  void place(const Prop& prop, std::stop_token) override { placed_.push_back(to_string(prop)); }

 private:
  std::vector<std::string>& placed_;
};

class StageTest : public testing::Test {
 protected:
  // The message that the run ended with; empty if it took all.
  std::string run() {
    bench_ = std::make_shared<FakeBench>();
    RigDevices devices = make_fake_devices(rig_, bench_);
    NoProgress progress;
    try {
      take_missing_shots(store_, devices, progress, {});
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }
  int taken(ShotKind kind) const {
    int count = 0;
    for (const FrameRecord& frame : store_.frames()) count += frame.role == to_string(kind) ? 1 : 0;
    return count;
  }
  bool logged(const std::string& part) const {
    for (const SessionEvent& event : store_.events()) {
      if (event.text.find(part) != std::string::npos) return true;
    }
    return false;
  }

  TemporaryFolder folder_;
  std::string rig_toml_ = small_rig_toml() + kBoard;
  RigDescription rig_ = parse_rig(rig_toml_, "rig");
  CapturePlan plan_ = parse_plan(small_plan_toml() + kLens, "plan");
  std::vector<Shot> shots_ = schedule_shots(plan_, rig_, "plan");
  SessionStore store_ = begin_session(
      folder_ / "s", {{{"rig.toml", rig_toml_}, {"plan.toml", small_plan_toml() + kLens}}, shots_, nullptr});
  std::shared_ptr<FakeBench> bench_;
};

TEST_F(StageTest, AnOperatorIsAskedForOneThingAtATime) {
  EXPECT_NE(run().find("placement 1"), std::string::npos);
  EXPECT_EQ(store_.frames().size(), 0u);
  EXPECT_FALSE(logged("on the operator's word"));
  EXPECT_NE(run().find("placement 2"), std::string::npos);
  EXPECT_TRUE(logged("board 1 stands there, on the operator's word"));
  EXPECT_EQ(taken(ShotKind::Board), 1);
  EXPECT_FALSE(bench_->ring_flash);  // a safe pause
  EXPECT_NE(run().find("diffuser before the lens"), std::string::npos);
  EXPECT_EQ(taken(ShotKind::Board), 2);
  EXPECT_NE(run().find("object on the table"), std::string::npos);
  EXPECT_EQ(taken(ShotKind::FlatField), 3);
  EXPECT_EQ(taken(ShotKind::Silhouette), 0);
  EXPECT_EQ(run(), "");
  EXPECT_TRUE(store_.missing_shots().empty());
}

// A fault while the board stands there is no change of the stage: the word still holds, and holds for that board only.
TEST_F(StageTest, AFaultInBetweenAsksForNothingNew) {
  run();
  {
    bench_ = std::make_shared<FakeBench>();
    RigDevices devices = make_fake_devices(rig_, bench_);
    bench_->before_exposure = [] { throw Disconnected("the camera is gone"); };
    NoProgress progress;
    EXPECT_THROW(take_missing_shots(store_, devices, progress, {}), Disconnected);
  }
  EXPECT_NE(run().find("placement 2"), std::string::npos);
  EXPECT_EQ(taken(ShotKind::Board), 1);
}

TEST_F(StageTest, PlansWithoutALensNeverAsk) {
  SessionStore plain = begin_session(
      folder_ / "plain", {{{"rig.toml", rig_toml_}}, schedule_shots(small_plan(), rig_, "plan"), nullptr});
  const auto bench = std::make_shared<FakeBench>();
  RigDevices devices = make_fake_devices(rig_, bench);
  NoProgress progress;
  take_missing_shots(plain, devices, progress, {});
  EXPECT_TRUE(plain.missing_shots().empty());
}

TEST_F(StageTest, AStageHandPlacesEachThingOnce) {
  const auto bench = std::make_shared<FakeBench>();
  RigDevices devices = make_fake_devices(rig_, bench);
  std::vector<std::string> placed;
  devices.stage = std::make_unique<RecordingHand>(placed);
  NoProgress progress;
  take_missing_shots(store_, devices, progress, {});
  EXPECT_TRUE(store_.missing_shots().empty());
  EXPECT_EQ(placed, (std::vector<std::string>{"board 1", "board 2", "diffuser", "object"}));
}

TEST_F(StageTest, ARecordingReplaysItWithoutAsking) {
  while (!run().empty()) {
  }
  const auto recording = std::make_shared<const SessionStore>(SessionStore::open(folder_ / "s", OpenMode::ReadOnly));
  SessionStore replay = begin_session(folder_ / "r", {{{"rig.toml", rig_toml_}}, shots_, nullptr});
  RigDevices devices = make_recorded_devices(recording, recorded_frames(*recording));
  NoProgress progress;
  take_missing_shots(replay, devices, progress, {});
  ASSERT_EQ(replay.frames().size(), store_.frames().size());
  for (std::size_t i = 0; i < shots_.size(); ++i) EXPECT_EQ(replay.frames()[i].sha256, store_.frames()[i].sha256);
}

TEST(Prop, NamesAreReadBack) {
  for (const Prop& prop : {Prop{}, Prop{Prop::Kind::Board, 12}, Prop{Prop::Kind::Diffuser, 0}}) {
    EXPECT_EQ(prop_from_string(to_string(prop)), prop);
  }
  for (const char* text : {"", "board", "board ", "board 0", "board 1x", "boards 1", "lens"}) {
    EXPECT_FALSE(prop_from_string(text)) << text;
  }
}

}  // namespace
}  // namespace lumitexel
