#include "rig/sequencer.h"

#include <cmath>
#include <exception>
#include <optional>
#include <sstream>

#include "drivers/error.h"
#include "rig/lighting.h"
#include "rig/raw_frame_file.h"

namespace lumitexel {
namespace {

double difference_deg(const AxisLimits& limits, double a, double b) {
  return limits.wraps ? std::abs(std::remainder(a - b, limits.max - limits.min)) : std::abs(a - b);
}

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
    if (difference_deg(limits_, position, *sent_to_) <= kAxisTolerance_deg) return position;
    std::ostringstream text;  // reached for NaN, too
    text << axis_.name() << ": sent to " << *sent_to_ << " deg, stands at " << position << " deg";
    throw Protocol(text.str());
  }

 private:
  Axis& axis_;
  AxisLimits limits_;
  std::optional<double> sent_to_;
};

class DarkAndStill {
 public:
  explicit DarkAndStill(RigDevices& devices) : devices_(devices) {}
  ~DarkAndStill() {
    for (Lamp* lamp : {devices_.point_light.get(), devices_.ring_flash.get(), devices_.backlight.get()}) {
      lamp->force_off();
    }
    for (Axis* axis : {devices_.turntable.get(), devices_.light_azimuth.get(), devices_.light_elevation.get()}) {
      axis->halt();
    }
  }
  DarkAndStill(const DarkAndStill&) = delete;
  DarkAndStill& operator=(const DarkAndStill&) = delete;

 private:
  RigDevices& devices_;
};

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

void require_whole(const Frame& frame, const CameraLimits& limits, const std::string& camera) {
  const bool same = frame.width_px == limits.width_px && frame.height_px == limits.height_px &&
                    frame.bits == limits.bits && frame.mosaic == limits.mosaic;
  if (same) return;
  std::ostringstream text;
  text << camera << ": a frame of " << frame.width_px << " x " << frame.height_px << " pixels, " << frame.bits
       << " bits, " << to_string(frame.mosaic) << " came from a camera of " << limits.width_px << " x "
       << limits.height_px << ", " << limits.bits << " bits, " << to_string(limits.mosaic);
  throw Protocol(text.str());
}

class Sequencer {
 public:
  Sequencer(RigDevices& devices, SessionStore& session, std::stop_token stop)
      : devices_(devices), stop_(std::move(stop)), discards_(devices, session), turntable_(*devices.turntable),
        light_azimuth_(*devices.light_azimuth), light_elevation_(*devices.light_elevation) {}

  void take(const Shot& shot, SessionStore& session) {
    if (stop_.stop_requested()) throw Cancelled("capture cancelled before shot " + std::to_string(shot.id));
    const Lighting lighting = lighting_of(shot.kind);
    switch_lamps(lighting, false);  // first, so that never two lamps are lit together
    turntable_.send_to(shot.turntable_deg, stop_);
    light_azimuth_.send_to(shot.light_azimuth_deg, stop_);
    light_elevation_.send_to(shot.light_elevation_deg, stop_);
    switch_lamps(lighting, true);
    discards_.begin_shot();
    const Frame frame =
        devices_.camera->shoot(shot.camera, stop_, static_cast<std::uint64_t>(shot.id), kShotAttempts);
    discards_.require_written();
    require_whole(frame, devices_.camera->limits(), devices_.camera->name());
    session.commit_frame(record_of(shot, frame), encode_pgm(frame));
  }

 private:
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
    record.name = frame_file_name(shot);
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
  std::stop_token stop_;
  DiscardJournal discards_;
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
  try {
    const DarkAndStill at_the_end(devices);
    Sequencer sequencer(devices, session, stop);
    for (const Shot& shot : missing) {
      sequencer.take(shot, session);
      progress.update(++summary.shots);
    }
  } catch (const std::exception& error) {
    log_fault(session, error.what(), devices.clock->utc_ns());
    throw;
  }
  summary.seconds = devices.clock->now_s() - start_s;
  session.log_event("info", "end: " + std::to_string(summary.shots) + " shots taken", devices.clock->utc_ns());
  return summary;
}

}  // namespace lumitexel
