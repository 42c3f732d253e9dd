// The bench behind the recorded devices: where the axes were sent, what is lit, and which part of the recording has
// been played. It moves at once, since the time that everything took is in the recording.
#pragma once

#include <array>
#include <limits>
#include <memory>
#include <stop_token>

#include "drivers/camera.h"
#include "drivers/motion.h"
#include "rig/lighting.h"
#include "rig/recorded_clock.h"
#include "rig/recording.h"
#include "rig/rig_description.h"
#include "rig/stage_hand.h"

namespace lumitexel {

enum class RecordedAxis { Turntable, LightAzimuth, LightElevation };

class RecordedBench {
 public:
  // Throws BadInput if the recording is not a captured session, Corrupt if its rig.toml cannot be used.
  RecordedBench(std::shared_ptr<const SessionStore> recording, RecordedRun run);

  const std::shared_ptr<RecordedClock>& clock() const { return clock_; }
  std::string camera_name() const { return "recorded camera (" + recording_->directory().string() + ")"; }
  // The recorded rig's; frames that its camera dropped unseen were not recorded.
  const CameraLimits& camera_limits() const { return camera_limits_; }
  const AxisLimits& limits(RecordedAxis axis) const { return limits_[static_cast<std::size_t>(axis)]; }

  void send(RecordedAxis axis, double target);
  // Where it was sent; once a frame has been delivered, what was read back for that frame.
  double reading(RecordedAxis axis) const { return reading_[static_cast<std::size_t>(axis)]; }
  Lighting& lamps() { return lamps_; }
  void place(const Prop& prop) { placed_ = prop; }

  // What the camera delivered next for these settings, with axes, lamps and stage as they are; of several shots that were
  // taken so the one with the id `frame_key`, else the first not yet played. Sets the clock to the recorded time.
  //   a recorded frame           it; throws Corrupt if it is not what was committed
  //   a frame that was discarded for its settings or its name: a black one that says the same of itself
  //   any other failed attempt   Protocol, with the recorded cause
  //   nothing (more)             OutOfRange, naming what was asked for: trying again would not help
  Frame expose(const CameraSettings& settings, std::uint64_t frame_key, std::stop_token stop);

 private:
  struct Unplayed {
    RecordedShoot shoot;
    std::size_t discards_played = 0;
    bool done = false;
  };
  bool taken_so(const RecordedShoot& shoot, const CameraSettings& settings) const;
  Unplayed& find(const CameraSettings& settings, std::uint64_t frame_key);
  Frame deliver(Unplayed& unplayed, std::stop_token stop);
  Frame repeat_discard(const DiscardRecord& discard, std::uint64_t frame_key) const;
  [[noreturn]] void fail_finding(const CameraSettings& settings, std::uint64_t frame_key) const;

  std::shared_ptr<const SessionStore> recording_;
  std::vector<Unplayed> shoots_;
  std::shared_ptr<RecordedClock> clock_;
  CameraLimits camera_limits_;
  std::array<AxisLimits, 3> limits_;
  std::array<double, 3> sent_{}, reading_{};
  Lighting lamps_;
  Prop placed_;
  std::uint64_t delivered_ = 0;
  double last_device_time_s_ = -std::numeric_limits<double>::infinity();  // since the camera was connected
};

}  // namespace lumitexel
