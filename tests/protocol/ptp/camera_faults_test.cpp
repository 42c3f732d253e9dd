// One fault at a time, wherever in a session it can happen: what comes out is a correct frame, or the right error in
// time.
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <sstream>
#include <thread>

#include "drivers/error.h"
#include "tests/protocol/ptp/still_bench.h"

namespace lumitexel {
namespace {

// Far above what a loaded machine needs to answer, and far below libgphoto2's own patience of 2.5 s.
constexpr double kAnswerTimeout_s = 1.0;
constexpr double kLateReply_s = 1.3;
// Three attempts of a few messages each, each with the timeout above; most cases end within 2 s.
constexpr double kShotDeadline_s = 12.0;

const CameraSettings kFirst{0.004, 0.0}, kSecond{0.0333, 20.0 * std::log10(2.0)};

struct Outcome {
  std::uint64_t struck_at = 0;  // the operation that went wrong; 0: none did
  std::string complaint;        // empty: all is as it should be
};

// Two shots; a card that is full must be said to be full, and only that.
void shoot_both(GphotoCamera& camera, const Clock& clock, std::ostream& complaint) {
  std::uint64_t key = 70;
  int full = 0;
  for (const CameraSettings& settings : {kFirst, kSecond}) {
    ++key;
    const double start_s = clock.now_s();
    try {
      complaint << objection_to(camera.shoot(settings, {}, key), settings, key);
    } catch (const StorageFull& error) {
      ++full;
      if (std::string(error.what()).find(camera.name()) == std::string::npos) complaint << "nameless: " << error.what();
    }
    if (clock.now_s() - start_s > kShotDeadline_s) complaint << "took " << clock.now_s() - start_s << " s; ";
  }
  if (full > 1) complaint << "the card was full twice; ";
}

Outcome session_with(Fault fault, std::uint64_t at) {
  Outcome outcome;
  std::ostringstream complaint;
  const auto faults = std::make_shared<OneFault>("camera", fault, at, at);
  const auto clock = std::make_shared<SystemClock>();
  {
    const auto server = serve(still_bench(), faults, kLateReply_s);
    pid_t worker = 0;
    try {
      GphotoCamera camera(connection_to(*server, kAnswerTimeout_s), still_rig().camera.limits, clock,
                          LUMITEXEL_GPHOTO_WORKER);
      shoot_both(camera, *clock, complaint);
      worker = camera.worker_pid();
    } catch (const std::exception& error) {
      complaint << "threw " << error.what();
    }
    if (worker != 0 && is_alive(worker)) complaint << "its worker lives on; ";
  }
  if (!faults->injected().empty()) outcome.struck_at = faults->injected().front().count;
  outcome.complaint = complaint.str();
  return outcome;
}

// Where in a session without faults the operation of this name comes for the nth time.
class Recorder final : public FaultSource {
 public:
  Recorder() : FaultSource(1) {}
  std::vector<std::string> names;

 private:
  Fault choose(const std::string&, const std::string& operation, std::uint64_t, const std::vector<Fault>&) override {
    names.push_back(operation);
    return Fault::None;
  }
};

std::vector<std::string> recorded_operations() {
  const auto recorder = std::make_shared<Recorder>();
  const auto server = serve(still_bench(), recorder);
  std::ostringstream complaint;
  const auto clock = std::make_shared<SystemClock>();
  GphotoCamera camera(connection_to(*server), still_rig().camera.limits, clock, LUMITEXEL_GPHOTO_WORKER);
  shoot_both(camera, *clock, complaint);
  EXPECT_EQ(complaint.str(), "");
  return recorder->names;
}

const std::vector<std::string>& operations_of_a_session() {
  static const std::vector<std::string> names = recorded_operations();
  return names;
}

// Cases wait far more than they work: many at a time.
void run_all(const std::vector<std::pair<Fault, std::uint64_t>>& cases) {
  std::atomic<std::size_t> next = 0, struck = 0;
  std::mutex mutex;
  std::vector<std::jthread> threads;
  for (int i = 0; i < 16; ++i) {
    threads.emplace_back([&] {
      for (std::size_t at = next++; at < cases.size(); at = next++) {
        const auto [fault, operation] = cases[at];
        const Outcome outcome = session_with(fault, operation);
        struck += outcome.struck_at != 0;
        const std::lock_guard lock(mutex);
        EXPECT_EQ(outcome.complaint, "") << to_string(fault) << " at operation " << operation;
      }
    });
  }
  threads.clear();
  EXPECT_EQ(struck, cases.size());
}

TEST(CameraFaults, AnyFaultAnywhereEndsInACorrectFrame) {
  const std::vector<std::string>& names = operations_of_a_session();
  std::vector<std::pair<Fault, std::uint64_t>> cases;
  for (std::size_t i = 0; i < names.size(); ++i) {
    for (const Fault fault :
         {Fault::Mute, Fault::LateReply, Fault::Exception, Fault::Garbage, Fault::HalfReply, Fault::Disconnect}) {
      // A camera's event has no answer that could be an error.
      if (fault == Fault::Exception && names[i] == "event" && i + 1 == names.size()) continue;
      cases.emplace_back(fault, i + 1);
    }
  }
  std::printf("%zu operations in a session of two shots, %zu cases\n", names.size(), cases.size());
  run_all(cases);
}

TEST(CameraFaults, PicturesThatAreNotWhatWasAskedForAreShotAgain) {
  const std::vector<std::string>& names = operations_of_a_session();
  std::vector<std::uint64_t> captures;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (names[i] == "capture") captures.push_back(i + 1);
  }
  ASSERT_EQ(captures.size(), 2u);
  std::vector<std::pair<Fault, std::uint64_t>> cases;
  for (const Fault fault :
       {Fault::LateSettings, Fault::FalseMetadata, Fault::StaleFrame, Fault::Wedge, Fault::CardFull}) {
    for (const std::uint64_t capture : captures) cases.emplace_back(fault, capture);
  }
  run_all(cases);
}

// What the base class was told, for one fault at the second shot.
std::vector<std::string> causes_of(Fault fault, const std::string& frame_name_setting) {
  const std::vector<std::string>& names = operations_of_a_session();
  const auto second = static_cast<std::uint64_t>(names.rend() - std::find(names.rbegin(), names.rend(), "capture"));
  // Without names a session has fewer operations; its second capture is then the first one after the first capture.
  const auto first = static_cast<std::uint64_t>(std::find(names.begin(), names.end(), "capture") - names.begin());
  const auto faults = std::make_shared<OneFault>("camera", fault, frame_name_setting.empty() ? first + 2 : second, 3);
  const auto server = serve(still_bench(), faults, kLateReply_s);
  GphotoConnection connection = connection_to(*server, 2.0 * kAnswerTimeout_s);
  connection.frame_name_setting = frame_name_setting;
  GphotoCamera camera(connection, still_rig().camera.limits, std::make_shared<SystemClock>(), LUMITEXEL_GPHOTO_WORKER);
  std::vector<std::string> causes;
  camera.on_discard([&](const DiscardedFrame& discarded) { causes.push_back(discarded.cause); });
  camera.shoot(kFirst, {}, 1);
  EXPECT_EQ(camera.shoot(kSecond, {}, 2).reported, kSecond);
  EXPECT_EQ(faults->injected().size(), 1u);
  return causes;
}

TEST(CameraFaults, TheCauseIsNamed) {
  const auto expect_cause = [](Fault fault, const std::string& setting, const std::string& part) {
    const auto causes = causes_of(fault, setting);
    ASSERT_EQ(causes.size(), 1u) << to_string(fault);
    EXPECT_NE(causes.front().find(part), std::string::npos) << to_string(fault) << ": " << causes.front();
  };
  expect_cause(Fault::LateSettings, "501e", "the frame reports 0.004 s");
  expect_cause(Fault::FalseMetadata, "501e", "the frame reports 0.0666 s");
  expect_cause(Fault::Wedge, "501e", "capture: no answer within");
  expect_cause(Fault::StaleFrame, "501e", "the frame reports 0.004 s");
  expect_cause(Fault::StaleFrame, "", "the frame reports 0.004 s");
}

// The same settings twice: only name, count or time tell the frames apart.
TEST(CameraFaults, AStaleFrameWithTheRightSettingsIsFoundOut) {
  const std::vector<std::string>& names = operations_of_a_session();
  const auto first = static_cast<std::uint64_t>(std::find(names.begin(), names.end(), "capture") - names.begin());
  for (const std::string setting : {"501e", ""}) {
    const auto faults = std::make_shared<OneFault>("camera", Fault::StaleFrame, first + 2);
    const auto server = serve(still_bench(), faults);
    GphotoConnection connection = connection_to(*server);
    connection.frame_name_setting = setting;
    GphotoCamera camera(connection, still_rig().camera.limits, std::make_shared<SystemClock>(),
                        LUMITEXEL_GPHOTO_WORKER);
    std::vector<std::string> causes;
    camera.on_discard([&](const DiscardedFrame& discarded) { causes.push_back(discarded.cause); });
    const Frame one = camera.shoot(kFirst, {}, 1), two = camera.shoot(kFirst, {}, 2);
    EXPECT_NE(one.camera_file, two.camera_file);
    EXPECT_EQ(faults->injected().size(), 1u);
    ASSERT_EQ(causes.size(), 1u);
    EXPECT_NE(causes.front().find(setting.empty() ? "delivered before" : "named 1"), std::string::npos)
        << causes.front();
  }
}

// Many shots, faults of all kinds at random: whatever is delivered is right. Three attempts may all fail; the shot is
// then asked for again, as a sequencer would after a pause.
TEST(CameraFaults, ManyShotsWithFaultsAtRandomMixNothingUp) {
  constexpr int kSeeds = 4, kShots = 12;
  std::atomic<int> wrong = 0, pauses = 0, discarded = 0;
  std::vector<std::jthread> threads;
  for (std::uint64_t seed = 1; seed <= kSeeds; ++seed) {
    threads.emplace_back([&, seed] {
      std::map<Fault, double> odds;
      for (const Fault fault : {Fault::Mute, Fault::Exception, Fault::Garbage, Fault::HalfReply, Fault::Disconnect,
                                Fault::LateSettings, Fault::FalseMetadata, Fault::StaleFrame, Fault::Wedge}) {
        odds[fault] = 0.004;
      }
      const auto server = serve(still_bench(), std::make_shared<RandomFaults>(odds, seed), kLateReply_s);
      GphotoCamera camera(connection_to(*server, kAnswerTimeout_s), still_rig().camera.limits,
                          std::make_shared<SystemClock>(), LUMITEXEL_GPHOTO_WORKER);
      camera.on_discard([&](const DiscardedFrame&) { ++discarded; });
      for (std::uint64_t key = 1; key <= kShots;) {
        const CameraSettings& settings = key % 3 == 0 ? kFirst : kSecond;
        try {
          wrong += !objection_to(camera.shoot(settings, {}, key), settings, key).empty();
          ++key;
        } catch (const Error&) {
          ++pauses;
        }
      }
    });
  }
  threads.clear();
  std::printf("%d shots: %d attempts discarded, %d safe pauses, %d wrong frames\n", kSeeds * kShots, discarded.load(),
              pauses.load(), wrong.load());
  EXPECT_EQ(wrong, 0);
  EXPECT_GT(discarded, 0);
}

}  // namespace
}  // namespace lumitexel
