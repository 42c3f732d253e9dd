// Frames that are not what was asked for, or say so falsely, are discarded and shot again.
#include <gtest/gtest.h>

#include "drivers/error.h"
#include "tests/protocol/gige/gige_bench.h"

namespace lumitexel {
namespace {

const CameraSettings kShort{0.01, 0.0}, kLong{0.03, 6.0};

struct Session {
  explicit Session(const GigeCameraOptions& options, int known_latency = 0,
                   std::shared_ptr<FaultSource> faults = std::make_shared<NoFaults>(), bool named = true)
      : bench(pattern_bench(small_limits())), server(serve_camera(bench, options, std::move(faults))) {
    CameraLimits limits = small_limits();
    limits.settings_latency_frames = known_latency;
    AravisConnection connection = named ? connection_to(*server) : unnamed_connection_to(*server);
    connection.answer_timeout_s = 0.5;
    camera = connect(connection, limits);
    discards = record_discards(*camera);
  }
  std::shared_ptr<SimulatedBench> bench;
  std::unique_ptr<GigeCameraServer> server;
  std::unique_ptr<AravisCamera> camera;
  std::shared_ptr<std::vector<DiscardedFrame>> discards;
};

class LateSettings : public testing::TestWithParam<int> {};

TEST_P(LateSettings, ThatTheRigKnowsOfReachEveryFrame) {
  Session session({.settings_latency_frames = GetParam()}, GetParam());
  for (const CameraSettings& asked : {kShort, kLong, kLong, kShort}) {
    EXPECT_TRUE(same_settings(strip_of(session.camera->shoot(asked, {}, 1)).settings, asked));
  }
  EXPECT_TRUE(session.discards->empty());
}

TEST_P(LateSettings, ThatTheChunksHideReachEveryFrameIfTheRigKnows) {
  Session session({.settings_latency_frames = GetParam(), .metadata_from_registers = true}, GetParam());
  for (const CameraSettings& asked : {kShort, kLong, kLong, kShort}) {
    EXPECT_TRUE(same_settings(strip_of(session.camera->shoot(asked, {}, 1)).settings, asked));
  }
}

TEST_P(LateSettings, ThatNobodyKnowsOfAreSeenInTheChunks) {
  Session session({.settings_latency_frames = GetParam()});
  session.camera->shoot({0.001, 0.0}, {}, 1);  // what the camera begins with
  const CameraSettings longer{0.03, 0.0};
  constexpr int kAttempts = 3;
  if (GetParam() < kAttempts) {
    EXPECT_TRUE(same_settings(strip_of(session.camera->shoot(longer, {}, 2, kAttempts)).settings, longer));
  } else {
    EXPECT_THROW(session.camera->shoot(longer, {}, 2, kAttempts), Protocol);
  }
  EXPECT_EQ(session.discards->size(), static_cast<std::size_t>(std::min(GetParam(), kAttempts)));
}

INSTANTIATE_TEST_SUITE_P(ByFrames, LateSettings, testing::Range(0, 6));

// Fails if the simulated camera forgets how to lie: then the test above would prove nothing.
TEST(LateSettingsUnknown, AndHiddenByTheChunksGoUnnoticed) {
  Session session({.settings_latency_frames = 1, .metadata_from_registers = true});
  session.camera->shoot(kShort, {}, 1);
  const Frame frame = session.camera->shoot(kLong, {}, 2);
  EXPECT_TRUE(same_settings(frame.reported, kLong));
  EXPECT_TRUE(same_settings(strip_of(frame).settings, kShort));
}

struct Falsehood {
  Fault fault;
  bool named, dated;
};

class GigeFalsehood : public testing::TestWithParam<Falsehood> {};

TEST_P(GigeFalsehood, IsDiscardedAndShotAgain) {
  // By seed: under the block id of before, which the library drops, and under a new one.
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const auto faults = std::make_shared<OneFault>("camera", GetParam().fault, 1, seed);
    Session session({.timestamp_latch = GetParam().dated}, 0, faults, GetParam().named);
    for (std::uint64_t key = 1; key <= 3; ++key) {
      const CameraSettings asked = key == 1 ? kShort : kLong;
      const Frame frame = session.camera->shoot(asked, {}, key);
      EXPECT_TRUE(same_settings(strip_of(frame).settings, asked)) << "frame " << key << ", seed " << seed;
      EXPECT_EQ(frame.samples, expected_samples(*session.bench, frame));
      if (GetParam().named) {
        EXPECT_EQ(strip_of(frame).frame_key, key) << "seed " << seed;
      }
    }
    EXPECT_EQ(faults->injected().size(), 1u);
    EXPECT_EQ(session.discards->size(), 1u) << "seed " << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Each, GigeFalsehood,
                         testing::Values(Falsehood{Fault::StaleFrame, true, true},
                                         Falsehood{Fault::StaleFrame, false, true},
                                         Falsehood{Fault::StaleFrame, false, false},
                                         Falsehood{Fault::FalseMetadata, true, true},
                                         Falsehood{Fault::LateSettings, true, true}),
                         [](const auto& param) {
                           return std::string(to_string(param.param.fault)) + (param.param.named ? "_named" : "_unnamed") +
                                  (param.param.dated ? "_dated" : "_undated");
                         });

TEST(GigeCommands, ExecutedTwiceByTheCameraDoNotPassAFrameForAnother) {
  // The answer to each of the first commands in turn is lost: sent again, the command is carried out again.
  for (std::uint64_t at = 200; at < 222; at += 6) {
    Session session({.repeats_commands = true}, 0, std::make_shared<OneFault>("camera", Fault::LateReply, at, at));
    for (std::uint64_t key = 1; key <= 12; ++key) {
      const CameraSettings asked = key % 2 ? kShort : kLong;
      const Frame frame = session.camera->shoot(asked, {}, key);
      EXPECT_TRUE(same_settings(strip_of(frame).settings, asked));
      EXPECT_EQ(strip_of(frame).frame_key, key);
    }
  }
}

}  // namespace
}  // namespace lumitexel
