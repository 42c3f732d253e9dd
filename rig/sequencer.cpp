#include "rig/sequencer.h"

#include <cmath>
#include <optional>
#include <sstream>

#include "drivers/error.h"
#include "rig/raw_frame_file.h"

namespace lumitexel {
namespace {

struct Lighting {
  bool point, ring, back;
};

Lighting lighting_of(ShotKind kind) {
  switch (kind) {
    case ShotKind::Silhouette: return {false, false, true};
    case ShotKind::SpheresRing: return {false, true, false};
    case ShotKind::SpheresPoint:
    case ShotKind::Object:
    case ShotKind::GrayCard: return {true, false, false};
    case ShotKind::Dark: break;
  }
  return {false, false, false};
}

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
  Sequencer(RigDevices& devices, std::stop_token stop)
      : devices_(devices), stop_(std::move(stop)), turntable_(*devices.turntable),
        light_azimuth_(*devices.light_azimuth), light_elevation_(*devices.light_elevation) {}

  void take(const Shot& shot, SessionStore& session) {
    if (stop_.stop_requested()) throw Cancelled("capture cancelled before shot " + std::to_string(shot.id));
    const Lighting lighting = lighting_of(shot.kind);
    switch_lamps(lighting, false);  // first, so that never two lamps are lit together
    turntable_.send_to(shot.turntable_deg, stop_);
    light_azimuth_.send_to(shot.light_azimuth_deg, stop_);
    light_elevation_.send_to(shot.light_elevation_deg, stop_);
    switch_lamps(lighting, true);
    const Frame frame = devices_.camera->shoot(shot.camera, stop_, static_cast<std::uint64_t>(shot.id));
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
  const std::vector<Shot> missing = session.missing_shots();
  const double start_s = devices.clock->now_s();
  session.log_event("info", "begin: " + std::to_string(missing.size()) + " shots missing", devices.clock->utc_ns());
  progress.begin("photographing", static_cast<std::int64_t>(missing.size()), "shots");
  SequenceSummary summary;
  try {
    const DarkAndStill at_the_end(devices);
    Sequencer sequencer(devices, stop);
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
