#include "tests/protocol/session/single_faults.h"

#include <atomic>
#include <thread>

#include "drivers/error.h"
#include "tests/protocol/session/attended_capture.h"
#include "tests/protocol/session/session_checker.h"
#include "tests/protocol/session/synthetic_shots.h"

namespace lumitexel {
namespace {

constexpr int kShots = 4, kShotsAPlace = 2;
const std::string kNotSafe = "not safe: ";

struct ShortSession {
  ShortSession(CameraKind camera, std::shared_ptr<FaultSource> faults)
      : rig([&] {
          ProtocolRigOptions options;
          options.camera = camera;
          options.faults = std::move(faults);
          return options;
        }()),
        session(SessionStore::create(folder / "session", SessionKind::Captured)) {
    session.put_shots(synthetic_shots(kShots, rig.rig(), 1, kShotsAPlace));
  }
  TemporaryFolder folder;
  ProtocolRig rig;
  SessionStore session;
};

std::string objection_to(const SafePause& pause) {
  if (pause.told_unsafe) return kNotSafe + pause.message;
  if (!pause.at_rest) return "paused with a lamp lit or an axis moving: " + pause.message;
  if (pause.device == "none") return "paused without naming a device: " + pause.message;
  if (pause.cause == "BadInput") return "blames the user: " + pause.message;
  return "";
}

std::string objection_to(const AttendedCapture& capture, const SessionStore& session) {
  for (const SafePause& pause : capture.pauses) {
    if (const std::string objection = objection_to(pause); !objection.empty()) return objection;
  }
  if (!capture.complete) return "never complete; last: " + capture.pauses.back().message;
  return check_session(session).text();
}

}  // namespace

std::string SingleFault::text() const {
  return std::string(camera == CameraKind::Gige ? "GigE rig, " : "still rig, ") + device + ": " + to_string(fault) +
         " at operation " + std::to_string(at);
}

SessionOperations count_operations(CameraKind camera) {
  const auto nothing = std::make_shared<NoFaults>();
  ShortSession run(camera, nothing);
  const AttendedCapture capture = capture_attended(run.rig, run.session);
  if (!capture.pauses.empty()) throw Error("a session without faults paused: " + capture.pauses.front().message);
  return {nothing->operations("camera"), nothing->operations("controller")};
}

std::vector<Fault> faults_of(CameraKind camera, const std::string& device) {
  std::vector<Fault> faults{Fault::Mute,    Fault::LateReply, Fault::Exception,
                            Fault::Garbage, Fault::HalfReply, Fault::Disconnect};
  if (device == "controller") {
    faults.insert(faults.end(), {Fault::StuckAxis, Fault::LampFails});
    return faults;
  }
  faults.insert(faults.end(), {Fault::Wedge, Fault::LateSettings, Fault::FalseMetadata, Fault::StaleFrame});
  if (camera == CameraKind::Still) faults.push_back(Fault::CardFull);
  else faults.insert(faults.end(), {Fault::LosePackets, Fault::ReorderPackets});
  return faults;
}

std::vector<SingleFault> fault_matrix(CameraKind camera, const SessionOperations& operations, std::uint64_t step) {
  std::vector<SingleFault> all;
  const auto add = [&](const std::string& device, std::uint64_t count) {
    std::uint64_t first = 0;  // another one for each fault, so that together they cover more
    for (const Fault fault : faults_of(camera, device)) {
      for (std::uint64_t at = 1 + first++ * 7 % step; at <= count; at += step) {
        all.push_back({camera, device, fault, at});
      }
    }
  };
  add("camera", operations.camera);
  add("controller", operations.controller);
  return all;
}

SingleFaultOutcome suffer(const SingleFault& what) {
  SystemClock clock;
  const double start_s = clock.now_s();
  SingleFaultOutcome outcome;
  outcome.what = what;
  try {
    const auto faults = std::make_shared<OneFault>(what.device, what.fault, what.at, what.at);
    ShortSession run(what.camera, faults);
    const AttendedCapture capture = capture_attended(run.rig, run.session, 5);
    outcome.happened = !faults->injected().empty();
    outcome.pauses = static_cast<int>(capture.pauses.size());
    outcome.objection = objection_to(capture, run.session);
    if (outcome.objection.empty() && !run.rig.is_at_rest()) outcome.objection = "a lamp lit or an axis moving at last";
  } catch (const std::exception& error) {
    outcome.objection = std::string("threw ") + error.what();
  }
  outcome.seconds = clock.now_s() - start_s;
  return outcome;
}

std::vector<SingleFaultOutcome> suffer_all(const std::vector<SingleFault>& all, int threads) {
  std::vector<SingleFaultOutcome> outcomes(all.size());
  std::atomic<std::size_t> next = 0;
  std::vector<std::jthread> workers;
  for (int i = 0; i < threads; ++i) {
    workers.emplace_back([&] {
      for (std::size_t mine = next++; mine < all.size(); mine = next++) outcomes[mine] = suffer(all[mine]);
    });
  }
  workers.clear();
  return outcomes;
}

}  // namespace lumitexel
