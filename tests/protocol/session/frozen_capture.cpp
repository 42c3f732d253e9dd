#include "tests/protocol/session/frozen_capture.h"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <limits>
#include <mutex>
#include <set>

#include "drivers/error.h"
#include "rig/sequencer.h"
#include "sim/protocol/modbus/modbus_controller_server.h"
#include "tests/protocol/session/synthetic_shots.h"

namespace lumitexel {
namespace {

using SteadyTime = std::chrono::steady_clock::time_point;

constexpr double kSlow_deg_per_s = 20.0;  // so that the axes are on their way when they are stopped

const std::set<std::string> kOfTable{"point light off", "ring flash off", "backlight off", "turntable stop"};
const std::set<std::string> kOfArm{"light azimuth stop", "light elevation stop"};

ProtocolRigOptions slow_rig() {
  ProtocolRigOptions options;
  options.speed_deg_per_s = kSlow_deg_per_s;
  return options;
}

// When the last of what is wanted had been done for the first time since `since`.
double latency_ms(const SimulatedController& controller, std::set<std::string> wanted, SteadyTime since) {
  for (const ReceivedStop& stop : controller.received_stops()) {
    if (stop.at < since) continue;
    wanted.erase(stop.what);
    if (wanted.empty()) return std::chrono::duration<double, std::milli>(stop.at - since).count();
  }
  return std::numeric_limits<double>::infinity();
}

void keep_reading(const Axis& axis, std::stop_token stop) {
  while (!stop.stop_requested()) {
    try {
      axis.position();
    } catch (const Error&) {
      // the line is held by the lane: that is what it is for
    }
  }
}

}  // namespace

// The sequencer tells of a frame from the thread that writes, as soon as it is committed.
class FrozenCapture::Hanging final : public Progress {
 public:
  void begin(const std::string&, std::int64_t, const std::string&) override {}
  void update(std::int64_t) override {
    std::unique_lock lock(mutex_);
    hangs_ = true;
    changed_.notify_all();
    changed_.wait(lock, [this] { return released_; });
  }
  bool wait_until_it_hangs() {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, std::chrono::seconds(20), [this] { return hangs_; });
  }
  void release() {
    const std::lock_guard lock(mutex_);
    released_ = true;
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool hangs_ = false, released_ = false;
};

FrozenCapture::FrozenCapture()
    : rig_(slow_rig()),
      session_(SessionStore::create(folder_ / "session", SessionKind::Captured)),
      devices_(rig_.connect()),
      progress_(std::make_unique<Hanging>()) {
  std::vector<Shot> shots = synthetic_shots(2, rig_.rig(), 1);
  for (Shot& shot : shots) shot.turntable_deg = shot.light_azimuth_deg = shot.light_elevation_deg = 0.0;
  session_.put_shots(shots);
  capture_ = std::jthread([this] {
    try {
      take_missing_shots(session_, devices_, *progress_, {});
    } catch (const Error&) {
      // the lane has tripped, and the capture is over once its writer is back
    }
  });
  if (!progress_->wait_until_it_hangs()) throw Timeout("frozen capture: no frame was committed");
  table_reader_ = std::jthread([this](std::stop_token stop) { keep_reading(*devices_.turntable, stop); });
  arm_reader_ = std::jthread([this](std::stop_token stop) { keep_reading(*devices_.light_azimuth, stop); });
}

FrozenCapture::~FrozenCapture() { progress_->release(); }

void FrozenCapture::set_going() {
  forward_ = !forward_;
  SimulatedBench& bench = rig_.bench();
  for (const BenchLamp lamp : kBenchLamps) bench.switch_lamp(lamp, true);
  bench.start_move(BenchAxis::LightAzimuth, forward_ ? 110.0 : -110.0);
  bench.start_move(BenchAxis::LightElevation, forward_ ? 85.0 : -20.0);
  bench.start_move(BenchAxis::Turntable, bench.motion(BenchAxis::Turntable).position + 170.0);
}

TripLatency FrozenCapture::trip() {
  set_going();
  const SteadyTime tripped = std::chrono::steady_clock::now();
  devices_.safety->trip("test of the safety lane");
  devices_.safety->wait_until_safe(std::chrono::seconds(2));
  const TripLatency latency{latency_ms(rig_.served().controller("table").controller(), kOfTable, tripped),
                            latency_ms(rig_.served().controller("arm").controller(), kOfArm, tripped)};
  devices_.safety->reset();
  return latency;
}

}  // namespace lumitexel
