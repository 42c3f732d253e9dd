// Devices without hardware or rendering that do what the interfaces promise, on virtual time. A frame's samples encode
// what the camera saw: settings, axes, lamps and the frame's key. What happened is kept in a log.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "rig/rig_description.h"
#include "rig/rig_devices.h"

namespace lumitexel {

struct FakeBench {
  VirtualClock clock;
  double turntable_deg = 0, light_azimuth_deg = 0, light_elevation_deg = 0;
  bool point_light = false, ring_flash = false, backlight = false;
  int moves = 0, switches = 0, frames = 0, forced_off = 0, halts = 0;
  std::function<void(Frame&)> tamper;        // changes a frame before it is delivered
  std::function<void()> before_exposure;     // may throw, cancel or watch
};

// The axes cover the rig's limits, the camera has the rig's.
RigDevices make_fake_devices(const RigDescription& rig, const std::shared_ptr<FakeBench>& bench);

}  // namespace lumitexel
