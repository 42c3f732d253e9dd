// A camera's settings by GenICam's names: those set once on connecting, those of each shot. Only for the .cpp files of
// this folder.
#pragma once

#include <cstdint>

#include "drivers/aravis/aravis_connection.h"
#include "drivers/aravis/aravis_device.h"
#include "drivers/aravis/pixel_layout.h"
#include "drivers/camera.h"

namespace lumitexel {

// What was found out about the camera while it was set up.
struct CameraSetup {
  PixelLayout layout;
  std::size_t payload_bytes = 0;
  bool exposure_chunk = false, gain_chunk = false, name_chunk = false;
  bool any_chunk() const { return exposure_chunk || gain_chunk || name_chunk; }
  bool gain = false;         // it can be set
  bool temperature = false;  // it can be read
  enum class Latch { None, Ticks, Nanoseconds } latch = Latch::None;  // of the camera's own time
  double ticks_per_s = 1e9;
};

// Stops acquisition, checks that the camera can do what the rig's description says, sets all that stays, and reads each
// setting back. Throws BadInput or OutOfRange naming the rig's key for what this camera cannot do, Protocol for what
// reads back otherwise, Timeout, Disconnected.
CameraSetup set_up(const AravisDevice& device, const AravisConnection& connection, const CameraLimits& limits);

void apply_settings(const AravisDevice& device, const CameraSetup& setup, const CameraSettings& settings);
CameraSettings read_settings(const AravisDevice& device, const CameraSetup& setup);

// Now, on the camera's own clock, in nanoseconds. setup.latch must not be None.
std::uint64_t latched_time_ns(const AravisDevice& device, const CameraSetup& setup);

}  // namespace lumitexel
