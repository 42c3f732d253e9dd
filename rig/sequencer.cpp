#include "rig/sequencer.h"

#include <cmath>
#include <exception>
#include <optional>
#include <sstream>

#include "drivers/error.h"
#include "rig/frame_file.h"
#include "rig/guarded_run.h"
#include "rig/lighting.h"
#include "rig/stage.h"

namespace lumitexel {
namespace {

// An axis that remembers where it was sent.
class SentAxis {
 public:
  explicit SentAxis(Axis& axis) : axis_(axis), limits_(axis.limits()) {}

  void send_to(double target, std::stop_token stop) {
    if (sent_to_ == target) return;
    sent_to_.reset();  // unknown while it moves
    axis_.move_to(target, stop);
    sent_to_ = target;
  }
  double read_back() const {
    const double position = axis_.position();
    if (distance_between(limits_, position, *sent_to_) <= kAxisTolerance_deg) return position;
    std::ostringstream text;  // reached for NaN, too
    text << axis_.name() << ": sent to " << *sent_to_ << " deg, stands at " << position << " deg";
    throw Protocol(text.str());
  }

 private:
  Axis& axis_;
  AxisLimits limits_;
  std::optional<double> sent_to_;
};

// A shot that takes longer than this many seconds beyond its moves and exposure, or a frame that is not on the disk by
// then, is a program or a disk that hangs: lamps must not burn on for that.
constexpr double kShotGrace_s = 60.0, kStoring_s = 10.0;

// Longest time that this axis may take for any motion.
double longest_motion_s(const AxisLimits& limits) {
  return 1.5 * (limits.max - limits.min) / limits.speed + limits.settle_s + limits.grace_s;
}

// Writes what the camera discards into the journal for as long as it lives. A journal that cannot be written stops the
// capture, but not from within the camera: an error thrown there would be taken for the camera's.
class DiscardJournal {
 public:
  DiscardJournal(RigDevices& devices, SessionStore& session) : camera_(*devices.camera) {
    camera_.on_discard([this, &devices, &session](const DiscardedFrame& frame) {
      try {
        session.log_discard({static_cast<std::int64_t>(frame.frame_key), ++attempt_, frame.asked, frame.reported,
                             frame.cause, devices.clock->utc_ns()});
      } catch (const Error&) {
        failure_ = std::current_exception();
      }
    });
  }
  ~DiscardJournal() { camera_.on_discard(nullptr); }
  DiscardJournal(const DiscardJournal&) = delete;
  DiscardJournal& operator=(const DiscardJournal&) = delete;

  void begin_shot() { attempt_ = 0; }
  void require_written() const {
    if (failure_) std::rethrow_exception(failure_);
  }

 private:
  Camera& camera_;
  int attempt_ = 0;
  std::exception_ptr failure_;
};

class Sequencer {
 public:
  Sequencer(RigDevices& devices, SessionStore& session, GuardedRun& guard)
      : devices_(devices), guard_(guard), stop_(guard.stop()), discards_(devices, session), stage_(devices, session),
        turntable_(*devices.turntable), light_azimuth_(*devices.light_azimuth), light_elevation_(*devices.light_elevation) {
    for (const Axis* axis : {devices.turntable.get(), devices.light_azimuth.get(), devices.light_elevation.get()}) {
      moves_s_ += longest_motion_s(axis->limits());
    }
  }

  void take(const Shot& shot, SessionStore& session) {
    if (stop_.stop_requested()) throw Cancelled("capture cancelled before shot " + std::to_string(shot.id));
    const std::string number = std::to_string(shot.id);
    guard_.expect_life_within(
        moves_s_ + devices_.camera->longest_shot_s(shot.camera, kShotAttempts) + kShotGrace_s, "taking shot " + number);
    const Frame frame = expose(shot);
    const NewFrame record = record_of(shot, frame);
    // Last: a lamp that went out or was switched off while the shutter was open spoils the frame.
    require_lit(lighting_of(shot.kind));
    if (stop_.stop_requested()) throw Cancelled("capture stopped during shot " + number);
    guard_.expect_life_within(kStoring_s, "storing the frame of shot " + number);
    session.commit_frame(record, stored_bytes(frame));
  }

 private:
  Frame expose(const Shot& shot) {
    const Lighting lighting = lighting_of(shot.kind);
    switch_lamps(lighting, false);  // first, so that never two lamps are lit together
    stage_.show(prop_for(shot), stop_);
    turntable_.send_to(shot.turntable_deg, stop_);
    light_azimuth_.send_to(shot.light_azimuth_deg, stop_);
    light_elevation_.send_to(shot.light_elevation_deg, stop_);
    switch_lamps(lighting, true);
    discards_.begin_shot();
    Frame frame = devices_.camera->shoot(shot.camera, stop_, static_cast<std::uint64_t>(shot.id), kShotAttempts);
    discards_.require_written();
    return frame;
  }

  void require_lit(const Lighting& lighting) const {
    const auto check = [](const Lamp& lamp, bool wanted) {
      if (lamp.is_on() == wanted) return;
      throw Protocol(lamp.name() + ": was to be " + (wanted ? "on" : "off") + " during the exposure, and is " +
                     (wanted ? "off" : "on") + " after it");
    };
    check(*devices_.point_light, lighting.point);
    check(*devices_.ring_flash, lighting.ring);
    check(*devices_.backlight, lighting.back);
  }

  // The lamps whose wanted state is `on`; the others stay as they are.
  void switch_lamps(const Lighting& lighting, bool on) {
    const auto turn = [&](Lamp& lamp, bool wanted) {
      if (wanted == on && lamp.is_on() != on) lamp.switch_to(on, stop_);
    };
    turn(*devices_.point_light, lighting.point);
    turn(*devices_.ring_flash, lighting.ring);
    turn(*devices_.backlight, lighting.back);
  }

  NewFrame record_of(const Shot& shot, const Frame& frame) const {
    NewFrame record;
    record.shot_id = shot.id;
    record.name = stored_name(shot, frame);
    record.role = to_string(shot.kind);
    record.requested = shot.camera;
    record.applied = devices_.camera->quantised(shot.camera);
    record.reported = frame.reported;
    record.utc_ns = devices_.clock->utc_ns();
    record.device_time_s = frame.device_time_s;
    record.sensor_temperature_c = frame.sensor_temperature_c;
    record.turntable_deg = turntable_.read_back();
    record.light_azimuth_deg = light_azimuth_.read_back();
    record.light_elevation_deg = light_elevation_.read_back();
    return record;
  }

  RigDevices& devices_;
  GuardedRun& guard_;
  std::stop_token stop_;
  double moves_s_ = 0;
  DiscardJournal discards_;
  Stage stage_;
  SentAxis turntable_, light_azimuth_, light_elevation_;
};

void log_fault(SessionStore& session, const std::string& what, std::int64_t utc_ns) {
  try {
    session.log_event("error", what, utc_ns);
  } catch (const Error&) {
    // The fault that is under way matters more; a full disk cannot take its own message.
  }
}

}  // namespace

SequenceSummary take_missing_shots(SessionStore& session, RigDevices& devices, Progress& progress,
                                   std::stop_token stop) {
  return take_shots(session, devices, session.missing_shots(), progress, std::move(stop));
}

SequenceSummary take_shots(SessionStore& session, RigDevices& devices, const std::vector<Shot>& missing,
                           Progress& progress, std::stop_token stop) {
  const double start_s = devices.clock->now_s();
  session.log_event("info", "begin: " + std::to_string(missing.size()) + " shots missing", devices.clock->utc_ns());
  progress.begin("photographing", static_cast<std::int64_t>(missing.size()), "shots");
  SequenceSummary summary;
  GuardedRun guard(devices, stop);
  try {
    Sequencer sequencer(devices, session, guard);
    for (const Shot& shot : missing) {
      sequencer.take(shot, session);
      progress.update(++summary.shots);
    }
    guard.finish();
  } catch (const std::exception& error) {
    // First of all, and before anything is written: dark and still.
    const std::string cause = guard.abandon(error.what());
    log_fault(session, cause, devices.clock->utc_ns());
    guard.rethrow_or_explain(cause);
  }
  summary.seconds = devices.clock->now_s() - start_s;
  session.log_event("info", "end: " + std::to_string(summary.shots) + " shots taken", devices.clock->utc_ns());
  return summary;
}

}  // namespace lumitexel
