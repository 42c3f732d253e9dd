// A camera that delivers single, software-triggered frames of raw sensor integers.
//
// A driver implements arm(), trigger() and recover(); the order of a shot and the judgement of its frame are fixed here,
// so that no driver can skip a part of them:
//
//            ┌────────────────── fault: recover() ◀─────────────────┐
//            ▼                                                      │
//   shoot ▶ arm ▶ read back = asked? ▶ drop late frames ▶ trigger ▶ frame acceptable? ▶ return it
//            ▲                                                      │
//            └────────────────── no: discard, say why ◀─────────────┘
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
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
  // The only exposures that there are, ascending, as a camera with a dial has them; empty: the step decides.
  std::vector<double> exposure_choices_s = {};
  double gain_min_db = -std::numeric_limits<double>::infinity();
  double gain_max_db = std::numeric_limits<double>::infinity();
  double gain_step_db = 0.0;  // 0: any value; else whole multiples
  // After a change of settings, so many frames may still be taken with the earlier ones whatever they report; they are
  // shot and dropped unseen. `lumitexel commission` measures it.
  int settings_latency_frames = 0;
};

// The settings nearest to the wanted ones that a camera with these limits can really apply; applying it twice changes
// nothing. Throws OutOfRange, naming the camera, outside the limits on exposure and gain.
CameraSettings quantise(const CameraSettings& wanted, const CameraLimits& limits, const std::string& camera_name);

// Whether a device that speaks in other units (microseconds, 1/250) means these settings: exposures within 1e-6 of
// each other relatively, gains within 1e-4 dB.
bool same_settings(const CameraSettings& a, const CameraSettings& b);

struct Frame {
  int width_px = 0, height_px = 0, bits = 16;
  Mosaic mosaic = Mosaic::Mono;
  std::vector<std::uint16_t> samples;  // row-major, width_px * height_px, untouched sensor integers
  CameraSettings reported;             // what the camera says that it used
  double device_time_s = 0.0;          // the camera's own timestamp
  double sensor_temperature_c = 0.0;
  std::uint64_t device_frame_id = 0;   // the camera's count, another one for every frame of a connection
  std::uint64_t frame_key = 0;         // what the caller of shoot() named the frame
  // The name that the camera itself wrote into the frame, where it can.
  std::optional<std::uint64_t> echoed_key;
  // A camera raw file, unchanged, which `samples` were decoded from; empty for cameras that deliver bare samples.
  std::vector<std::uint8_t> camera_file;
  std::string camera_file_extension;  // "dng", "cr2", …, without dot
};

// A frame that was not accepted, or an attempt that failed, and why.
struct DiscardedFrame {
  std::uint64_t frame_key = 0;
  CameraSettings asked;
  std::optional<CameraSettings> reported;  // empty where no frame came
  std::string cause;
};

class Camera {
 public:
  virtual ~Camera() = default;

  virtual std::string name() const = 0;
  virtual CameraLimits limits() const = 0;

  // quantise() with this camera's limits.
  CameraSettings quantised(const CameraSettings& wanted) const;

  // Takes one frame with exactly quantised(wanted). Accepted is a frame that has the camera's size, depth and mosaic,
  // reports the settings applied, is not one delivered before (a new device_frame_id, a later device_time_s) and, where
  // the camera writes names into its frames, carries this one. Anything else is discarded and shot again; so is an
  // attempt that failed by Timeout, Disconnected or Protocol. Before an attempt that follows a failed or cancelled one, of
  // this call or an earlier, comes recover(). After max_attempts throws what the last
  // one failed by (Protocol for a frame not accepted).
  // frame_key: the caller's name for the frame, such as the id of its shot. It is kept in the frame; a simulated
  // camera draws its noise by it, so that a shot taken after a restart is the shot that would have been taken before.
  // Throws also OutOfRange, StorageFull (a full card), Cancelled.
  Frame shoot(const CameraSettings& wanted, std::stop_token stop, std::uint64_t frame_key = 0, int max_attempts = 3);

  // The longest that one shoot() with these settings may take, whatever goes wrong.
  double longest_shot_s(const CameraSettings& settings, int max_attempts = 3) const;

  // Told of every discarded frame and failed attempt, from the thread that shoots.
  void on_discard(std::function<void(const DiscardedFrame&)> listener) { discard_listener_ = std::move(listener); }

 protected:
  // Applies the settings and returns what the device then says they are.
  virtual CameraSettings arm(const CameraSettings& settings, std::stop_token stop) = 0;
  // Blocks until the frame has arrived whole; never longer than a deadline of its own. Hardware may ignore frame_key.
  virtual Frame trigger(std::uint64_t frame_key, std::stop_token stop) = 0;
  // After a failed attempt: makes the device ready for arm() again, reconnecting if need be. Throws what it fails by.
  virtual void recover(std::stop_token stop);
  // The longest that recover() may take; for whoever watches over the whole shot.
  virtual double longest_recovery_s() const { return 0.0; }

 private:
  Frame accepted(Frame frame, const CameraSettings& settings, std::uint64_t frame_key);
  Frame attempt(const CameraSettings& settings, std::uint64_t frame_key, std::stop_token stop);
  std::string objection(const Frame& frame, const CameraSettings& settings, std::uint64_t frame_key) const;
  void discard(std::uint64_t key, const CameraSettings& asked, std::optional<CameraSettings> reported,
               const std::string& cause) const;

  std::function<void(const DiscardedFrame&)> discard_listener_;
  std::optional<CameraSettings> last_settings_;  // of the last accepted frame; empty after a fault
  std::optional<std::uint64_t> last_frame_id_;
  bool needs_recovery_ = false;  // something was thrown amid an attempt, of this shoot() or an earlier one
  double last_device_time_s_ = -std::numeric_limits<double>::infinity();
};

}  // namespace lumitexel
