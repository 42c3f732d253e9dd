// A camera that delivers single, software-triggered frames of raw sensor integers.
#pragma once

#include <cstdint>
#include <stop_token>
#include <string>
#include <vector>

namespace lumitexel {

enum class Mosaic { Mono, Rggb, Bggr, Grbg, Gbrg };  // colour of the pixels (0,0) (1,0) / (0,1) (1,1)

const char* to_string(Mosaic mosaic);        // "mono", "rggb", …
Mosaic mosaic_from_string(const std::string& name);  // throws BadInput on any other name

struct CameraSettings {
  double exposure_s = 0.01;
  double gain_db = 0.0;
  bool operator==(const CameraSettings&) const = default;
};

struct CameraLimits {
  int width_px = 0, height_px = 0;
  int bits = 16;  // significant bits; a sample lies in [0, 2^bits - 1]
  Mosaic mosaic = Mosaic::Mono;
  double exposure_min_s = 0.0, exposure_max_s = 0.0;
  double exposure_step_s = 0.0;  // 0: any value; else exposures are whole multiples
  double readout_s = 0.0;        // from the end of the exposure to the frame's arrival
};

// The settings nearest to the wanted ones that a camera with these limits can really apply; applying it twice changes
// nothing. Throws OutOfRange, naming the camera, outside exposure_min_s..exposure_max_s.
CameraSettings quantise(const CameraSettings& wanted, const CameraLimits& limits, const std::string& camera_name);

struct Frame {
  int width_px = 0, height_px = 0, bits = 16;
  Mosaic mosaic = Mosaic::Mono;
  std::vector<std::uint16_t> samples;  // row-major, width_px * height_px, untouched sensor integers
  CameraSettings reported;             // what the camera says that it used
  double device_time_s = 0.0;          // the camera's own timestamp
  double sensor_temperature_c = 0.0;
  std::uint64_t device_frame_id = 0;
  std::uint64_t frame_key = 0;         // what the caller of shoot() named the frame
};

// The sequence arm, trigger, verify is fixed here so that no driver can skip a part of it:
// shoot() returns a frame only if the settings reported with it are the ones applied.
class Camera {
 public:
  virtual ~Camera() = default;

  virtual std::string name() const = 0;
  virtual CameraLimits limits() const = 0;

  // quantise() with this camera's limits.
  CameraSettings quantised(const CameraSettings& wanted) const;

  // Takes one frame with exactly quantised(wanted). A frame that reports other settings is discarded
  // and shot again, up to max_attempts times in all; then throws Protocol.
  // frame_key: the caller's name for the frame, such as the id of its shot. It is kept in the frame; a simulated
  // camera draws its noise by it, so that a shot taken after a restart is the shot that would have been taken before.
  // Throws OutOfRange, Timeout, Disconnected, Protocol, Cancelled.
  Frame shoot(const CameraSettings& wanted, std::stop_token stop, std::uint64_t frame_key = 0, int max_attempts = 3);

 protected:
  virtual void arm(const CameraSettings& settings, std::stop_token stop) = 0;
  // Blocks until the frame has arrived. Hardware may ignore frame_key.
  virtual Frame trigger(std::uint64_t frame_key, std::stop_token stop) = 0;
};

}  // namespace lumitexel
