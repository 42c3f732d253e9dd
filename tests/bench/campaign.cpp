#include "tests/bench/campaign.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <memory>
#include <thread>

#include "tests/bench/campaign_faults.h"
#include "tests/protocol/session/attended_capture.h"
#include "tests/protocol/session/synthetic_shots.h"

namespace lumitexel {
namespace {

constexpr int kLatencies = 6;
constexpr double kTold_s = 10.0;

// A discard's cause without its particulars.
std::string kind_of(const std::string& cause) {
  constexpr std::array<std::pair<const char*, const char*>, 15> kKinds{
      {{"the frame reports", "reports other settings"},
       {"got the frame named", "another frame's name"},
       {"delivered before", "delivered before"},
       {"on the camera's clock", "not later than the frame before"},
       {"an earlier frame came", "exposed before its trigger"},
       {"reads back", "settings read back differ"},
       {"no frame", "no frame came"},
       {"missing packets", "packets missing"},
       {"incomplete", "frame incomplete"},
       {"control", "control lost"},
       {"not found", "camera not found"},
       {"not connected", "not connected"},
       {"busy", "busy"},
       {"does not answer", "no answer"},
       {"no answer", "no answer"}}};
  for (const auto& [part, kind] : kKinds) {
    if (cause.find(part) != std::string::npos) return kind;
  }
  const std::size_t name_end = cause.starts_with("camera ") ? cause.find(": ") : std::string::npos;
  std::string rest = cause.substr(name_end == std::string::npos ? 0 : name_end + 2, 90);
  for (char& c : rest) {
    if (c >= '0' && c <= '9') c = '#';
  }
  return rest;
}

struct Lane {
  CameraKind camera;
  int shots, number;
};

std::vector<Lane> lanes_of(const CampaignOptions& options) {
  std::vector<Lane> lanes;
  const int still = options.still_rigs > 0 ? std::min(options.still_shots, options.shots) : 0;
  const int gige = options.shots - still;
  const auto share = [](int all, int parts, int part) { return all / parts + (part < all % parts ? 1 : 0); };
  const auto add_rigs = [&](CameraKind camera, int shots, int rigs) {
    for (int i = 0; i < rigs; ++i) lanes.push_back({camera, share(shots, rigs, i), i});
  };
  add_rigs(CameraKind::Still, still, options.still_rigs);
  add_rigs(CameraKind::Gige, gige, options.gige_rigs);
  return lanes;
}

// Settings late by 0 to 5 frames while the chunks tell the registers: only the description knows. Packets lost and
// reordered at 1 to 5 % beside the faults.
ProtocolRigOptions rig_options(const Lane& lane, const CampaignOptions& options) {
  ProtocolRigOptions rig;
  rig.camera = lane.camera;
  rig.seed = options.seed;
  const std::uint64_t seed = 1000 * options.seed + static_cast<std::uint64_t>(lane.number);
  if (lane.camera == CameraKind::Still) {
    rig.faults = std::make_shared<FaultsByDevice>(still_rig_rates(options.fault_scale), seed + 500);
    return rig;
  }
  rig.faults = std::make_shared<FaultsByDevice>(gige_rig_rates(options.fault_scale), seed);
  rig.declared_latency_frames = lane.number % kLatencies;
  rig.serving.gige.settings_latency_frames = rig.declared_latency_frames;
  rig.serving.gige.metadata_from_registers = rig.declared_latency_frames > 0;
  rig.serving.gige.loss = rig.serving.gige.reorder = 0.01 * (1 + lane.number % 5);
  rig.serving.gige.seed = seed;
  return rig;
}

struct Outcome {
  SessionCheck check;
  AttendedCapture capture;
  std::map<std::string, int> discards;
};

Outcome run_lane(const Lane& lane, ProtocolRig& rig, const CampaignOptions& options) {
  const std::string name = (lane.camera == CameraKind::Gige ? "gige_" : "still_") + std::to_string(lane.number);
  Outcome outcome;
  {
    SessionStore session = SessionStore::create(options.folder / name, SessionKind::Captured);
    session.put_shots(synthetic_shots(lane.shots, rig.rig(), options.seed));
    outcome.capture = capture_attended(rig, session);
  }
  // As whoever finds the folder would read it.
  const SessionStore session = SessionStore::open(options.folder / name, OpenMode::ReadOnly);
  outcome.check = check_session(session);
  for (const DiscardRecord& discard : session.discards()) ++outcome.discards[kind_of(discard.cause)];
  return outcome;
}

void add_pauses(CampaignResult& result, const AttendedCapture& capture) {
  result.connections += capture.connections;
  result.incomplete_sessions += capture.complete ? 0 : 1;
  for (const SafePause& pause : capture.pauses) {
    ++result.pauses[pause.device + ": " + pause.cause + (pause.connecting ? " (connecting)" : "")];
    const bool named = pause.device != "none", safe = pause.at_rest || pause.told_unsafe;
    result.unnamed_pauses += named ? 0 : 1;
    result.unsafe_pauses += safe ? 0 : 1;
    result.told_unsafe_pauses += pause.told_unsafe ? 1 : 0;
    const bool expected = named && safe && pause.cause != "Error" && pause.cause != "BadInput";
    if (!expected) result.remarkable.push_back(pause.message);
  }
}

void add(CampaignResult& result, const Outcome& outcome) {
  result.check.shots += outcome.check.shots;
  result.check.frames += outcome.check.frames;
  result.check.wrong.insert(result.check.wrong.end(), outcome.check.wrong.begin(), outcome.check.wrong.end());
  result.mislabelled += outcome.check.mislabelled();
  result.lost += outcome.check.lost();
  result.duplicated += outcome.check.duplicated();
  for (const auto& [cause, count] : outcome.discards) result.discards[cause] += count;
  add_pauses(result, outcome.capture);
}

void add_faults(CampaignResult& result, const Lane& lane, const FaultSource& faults) {
  const auto place = [&](const std::string& device) {
    return device != "camera" ? device : lane.camera == CameraKind::Gige ? "camera (GigE)" : "camera (still)";
  };
  for (const InjectedFault& fault : faults.injected()) ++result.injected[to_string(fault.fault)][place(fault.device)];
  for (const char* device : {"camera", "controller"}) result.operations[place(device)] += faults.operations(device);
}

}  // namespace

CampaignResult run_campaign(const CampaignOptions& options, const std::function<void(std::uint64_t)>& told) {
  SystemClock clock;
  const double start_s = clock.now_s();
  if (options.still_rigs > 0) offer_only_the_ptp_driver();
  const std::vector<Lane> lanes = lanes_of(options);
  std::vector<std::unique_ptr<ProtocolRig>> rigs;
  std::vector<std::shared_ptr<FaultSource>> faults;
  for (const Lane& lane : lanes) {
    const ProtocolRigOptions rig = rig_options(lane, options);
    faults.push_back(rig.faults);
    rigs.push_back(std::make_unique<ProtocolRig>(rig));
  }
  const auto exposures = [&] {
    std::uint64_t sum = 0;
    for (const auto& rig : rigs) sum += rig->bench().exposures();
    return sum;
  };
  std::vector<Outcome> outcomes(lanes.size());
  std::vector<std::exception_ptr> failures(lanes.size());
  std::atomic<std::size_t> running = lanes.size();
  {
    std::vector<std::jthread> threads;
    for (std::size_t i = 0; i < lanes.size(); ++i) {
      threads.emplace_back([&, i] {
        try {
          outcomes[i] = run_lane(lanes[i], *rigs[i], options);
        } catch (...) {
          failures[i] = std::current_exception();
        }
        --running;
      });
    }
    for (double next_s = start_s + kTold_s; running > 0; next_s += kTold_s) {
      while (running > 0 && clock.now_s() < next_s) clock.sleep_until(clock.now_s() + 0.1, {});
      if (running > 0) told(exposures());
    }
  }
  for (const std::exception_ptr& failure : failures) {
    if (failure) std::rethrow_exception(failure);
  }
  CampaignResult result;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    add(result, outcomes[i]);
    add_faults(result, lanes[i], *faults[i]);
  }
  result.exposures = exposures();
  result.seconds = clock.now_s() - start_s;
  return result;
}

}  // namespace lumitexel
