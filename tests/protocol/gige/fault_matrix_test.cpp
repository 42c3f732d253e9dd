// One fault at each of a session's operations: every shot ends in a correct frame, whatever goes wrong once.
#include <gtest/gtest.h>

#include <atomic>
#include <sstream>
#include <thread>

#include "drivers/error.h"
#include "tests/protocol/gige/gige_bench.h"

namespace lumitexel {
namespace {

// Of each of three shots: the settings' writes and reads, name, clock, trigger, frame, temperature.
constexpr std::uint64_t kOperations = 28;
constexpr double kShotDeadline_s = 15.0;
constexpr int kThreads = 24;  // they wait most of the time

const std::vector<CameraSettings> kShots{{0.01, 0.0}, {0.02, 3.0}, {0.02, 6.0}};

struct Scenario {
  Fault fault;
  std::uint64_t at;
  std::string text() const { return std::string(to_string(fault)) + " at operation " + std::to_string(at); }
};

// Lets nothing go wrong, then one thing at so many operations from when it is told to begin.
class FaultAfterConnecting final : public FaultSource {
 public:
  explicit FaultAfterConnecting(const Scenario& scenario) : FaultSource(scenario.at), scenario_(scenario) {}
  void begin() { begun_ = true; }
  bool done() const { return done_; }

 private:
  Fault choose(const std::string&, const std::string&, std::uint64_t, const std::vector<Fault>& possible) override {
    if (!begun_ || done_ || ++seen_ < scenario_.at) return Fault::None;
    if (std::find(possible.begin(), possible.end(), scenario_.fault) == possible.end()) return Fault::None;
    done_ = true;
    return scenario_.fault;
  }
  Scenario scenario_;
  std::atomic<bool> begun_ = false, done_ = false;
  std::uint64_t seen_ = 0;
};

std::string causes(const std::vector<DiscardedFrame>& discards) {
  std::string text;
  for (const DiscardedFrame& discard : discards) text += "\n  discarded: " + discard.cause;
  return text;
}

void take_shots(AravisCamera& camera, SimulatedBench& bench, const std::string& what) {
  SystemClock clock;
  const auto discards = record_discards(camera);
  for (std::size_t i = 0; i < kShots.size(); ++i) {
    const double start_s = clock.now_s();
    try {
      const Frame frame = camera.shoot(kShots[i], {}, 100 + i);
      EXPECT_TRUE(same_settings(strip_of(frame).settings, kShots[i])) << what << ", shot " << i;
      EXPECT_EQ(strip_of(frame).frame_key, 100 + i) << what;
      EXPECT_EQ(frame.samples, expected_samples(bench, frame)) << what << ", shot " << i;
    } catch (const Error& error) {
      ADD_FAILURE() << what << ", shot " << i << ": " << error.what() << causes(*discards);
    }
    EXPECT_LT(clock.now_s() - start_s, kShotDeadline_s) << what << ", shot " << i;
  }
}

void run_session(const Scenario& scenario) {
  auto faults = std::make_shared<FaultAfterConnecting>(scenario);
  const auto bench = pattern_bench(small_limits());
  const auto server = serve_camera(bench, {}, faults);
  const auto camera = connect(connection_to(*server), small_limits());
  faults->begin();
  take_shots(*camera, *bench, scenario.text());
  EXPECT_TRUE(faults->done() || scenario.at > 20) << scenario.text() << " never happened";
}

void run_connecting(const Scenario& scenario) {
  const auto bench = pattern_bench(small_limits());
  const auto server = serve_camera(bench, {}, std::make_shared<OneFault>("camera", scenario.fault, scenario.at, scenario.at));
  try {
    const auto camera = connect(connection_to(*server), small_limits());
    take_shots(*camera, *bench, "connecting: " + scenario.text());
  } catch (const BadInput& error) {
    ADD_FAILURE() << scenario.text() << " blames the user: " << error.what();
  } catch (const Error& error) {
    const bool cause = dynamic_cast<const Timeout*>(&error) || dynamic_cast<const Disconnected*>(&error) ||
                       dynamic_cast<const Protocol*>(&error);
    EXPECT_TRUE(cause && std::string(error.what()).find("camera " + server->address()) != std::string::npos)
        << scenario.text() << ": " << error.what();
  }
}

void run_all(const std::vector<Scenario>& scenarios, void (*run)(const Scenario&)) {
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> threads;
  for (int i = 0; i < kThreads; ++i) {
    threads.emplace_back([&] {
      for (std::size_t mine = next++; mine < scenarios.size(); mine = next++) run(scenarios[mine]);
    });
  }
}

std::vector<Scenario> each_at(const std::vector<Fault>& faults, std::uint64_t first, std::uint64_t last,
                              std::uint64_t step) {
  std::vector<Scenario> scenarios;
  for (const Fault fault : faults) {
    for (std::uint64_t at = first; at <= last; at += step) scenarios.push_back({fault, at});
  }
  return scenarios;
}

const std::vector<Fault> kOfCommands{Fault::Disconnect, Fault::Mute,    Fault::LateReply,
                                     Fault::Exception,  Fault::Garbage, Fault::HalfReply};
const std::vector<Fault> kOfFrames{Fault::Wedge,         Fault::LosePackets,  Fault::ReorderPackets,
                                   Fault::FalseMetadata, Fault::LateSettings, Fault::StaleFrame};

TEST(GigeFaults, OfEachCommandOfASessionEndInCorrectFrames) {
  run_all(each_at(kOfCommands, 1, kOperations, 1), run_session);
}

TEST(GigeFaults, OfEachFrameOfASessionEndInCorrectFrames) {
  // The frames are about every tenth operation; a fault waits for the first one at which it is possible.
  run_all(each_at(kOfFrames, 1, 20, 4), run_session);
}

TEST(GigeFaults, WhileConnectingEndInCorrectFramesOrAnErrorThatNamesTheCamera) {
  run_all(each_at(kOfCommands, 1, 151, 25), run_connecting);
}

}  // namespace
}  // namespace lumitexel
