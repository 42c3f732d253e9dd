// The rig as commissioning uses it: a camera whose every frame is timed, under a light that is chosen.
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

#include "rig/commission/frame_statistics.h"
#include "rig/rig_description.h"
#include "rig/rig_devices.h"

namespace lumitexel {

struct TimedFrame {
  double shot_s = 0, arrived_s = 0;  // this machine's clock: before the call and after it
  double device_s = 0;
  double exposure_s = 0;
};

class TestBench {
 public:
  TestBench(RigDevices& devices, const RigDescription& rig, std::stop_token stop);
  ~TestBench();
  TestBench(const TestBench&) = delete;
  TestBench& operator=(const TestBench&) = delete;

  RigDevices& devices() { return devices_; }
  const RigDescription& rig() const { return rig_; }
  std::stop_token stop() const { return stop_; }

  void light_only(Lamp* lamp);  // nullptr: dark
  // Gain 0 dB, or the nearest that the camera has. Settled: after a change of exposure, as many frames are taken and dropped
  // as set_latency() says.
  Frame shoot(double exposure_s);
  Frame settled_shot(double exposure_s);
  void set_latency(int frames) { latency_frames_ = frames; }
  // An exposure whose brightest hundredth lies at about `share` of the range between black and saturation, under the light
  // that is on. Throws Error if the camera's range does not reach that.
  double exposure_for(double share);

  double top_dn() const;                                         // the highest code
  const std::vector<TimedFrame>& frames() const { return frames_; }  // all so far
  int late_frames() const { return late_frames_; }               // discarded since the last call of forget_late_frames()
  void forget_late_frames() { late_frames_ = 0; }

 private:
  CameraSettings settings_for(double exposure_s) const;

  RigDevices& devices_;
  const RigDescription& rig_;
  std::stop_token stop_;
  std::vector<TimedFrame> frames_;
  std::uint64_t key_ = 0;
  int late_frames_ = 0, latency_frames_ = 0;
};

}  // namespace lumitexel
