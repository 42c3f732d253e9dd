// The one bench behind all simulated devices, in process or behind a protocol: its axes, its lamps, its time, and what
// the camera sees of it. Devices hold no physics. Thread-safe.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <stop_token>
#include <vector>

#include "drivers/camera.h"
#include "drivers/clock.h"
#include "drivers/motion.h"
#include "rig/rig_description.h"
#include "sim/bench_behaviour.h"
#include "sim/world_state.h"

namespace lumitexel {

enum class BenchAxis { Turntable, LightAzimuth, LightElevation };
enum class BenchLamp { Point, Ring, Back };
inline constexpr std::array<BenchAxis, 3> kBenchAxes{BenchAxis::Turntable, BenchAxis::LightAzimuth,
                                                     BenchAxis::LightElevation};
inline constexpr std::array<BenchLamp, 3> kBenchLamps{BenchLamp::Point, BenchLamp::Ring, BenchLamp::Back};
const char* to_string(BenchAxis axis);  // "turntable", "light azimuth", "light elevation"
const char* to_string(BenchLamp lamp);  // "point light", "ring flash", "backlight"

// Sensor integers, row by row, for a state and settings; the noise is a function of the key alone.
// May be slow; called from several threads.
using PixelSource =
    std::function<std::vector<std::uint16_t>(const WorldState&, const CameraSettings&, std::uint64_t noise_key)>;

struct BenchMotion {
  double position = 0, target = 0;  // as the encoder says
  bool moving = false;
};

// One exposure as it really was: the truth that a delivered frame is held against.
struct BenchExposure {
  std::uint64_t count = 0;  // 1, 2, … of this bench
  CameraSettings settings;
  WorldState state;
  std::uint64_t frame_key = 0;
  double end_s = 0;  // on the bench's clock
  std::vector<std::uint16_t> samples;
};

class SimulatedBench {
 public:
  // The axes' ranges, speeds and the camera's size are the rig's. Axes stand at 0 or the nearest end of their range.
  SimulatedBench(const RigDescription& rig, const BenchBehaviour& behaviour, std::shared_ptr<Clock> clock,
                 PixelSource pixels);

  const std::shared_ptr<Clock>& clock() const { return clock_; }
  const BenchBehaviour& behaviour() const { return behaviour_; }
  const CameraDescription& camera() const { return camera_; }
  AxisLimits limits(BenchAxis axis) const;

  // Sets off from where the axis is now; a target beyond the range goes to the range's end.
  void start_move(BenchAxis axis, double target);
  void halt(BenchAxis axis);
  BenchMotion motion(BenchAxis axis) const;
  void switch_lamp(BenchLamp lamp, bool on);
  bool is_lit(BenchLamp lamp) const;

  void place(int board, bool flat_field);  // as WorldState has them

  // Faults: an axis that does not move any more until freed, a lamp that stays dark until mended.
  void jam(BenchAxis axis, bool jammed);
  void break_lamp(BenchLamp lamp, bool broken);

  // What the camera would see at this moment: true positions, not the encoders'.
  WorldState state() const;  // lamp and sensor as at the first shot
  // Takes settings.exposure_s on the clock, then computes. What is seen is the state at the exposure's middle; the
  // samples depend on the seed, the key, the settings and that state, and on nothing else. Throws Cancelled.
  BenchExposure expose(const CameraSettings& settings, std::uint64_t frame_key, std::stop_token stop);
  std::uint64_t exposures() const;  // so far

 private:
  struct AxisModel {
    AxisLimits limits;
    double from = 0, target = 0, start_s = 0;
    double rest_offset = 0;  // of the table against its encoder once it rests, from slack
    bool jammed = false;
  };
  BenchMotion motion_of(const AxisModel& axis, double now_s) const;
  double true_turntable_deg(double now_s) const;
  WorldState state_at(double now_s) const;
  std::uint64_t noise_key(const CameraSettings& settings, const WorldState& state, std::uint64_t frame_key) const;

  CameraDescription camera_;
  BenchBehaviour behaviour_;
  std::shared_ptr<Clock> clock_;
  PixelSource pixels_;
  mutable std::mutex mutex_;
  std::array<AxisModel, 3> axes_;
  std::array<bool, 3> lit_{}, broken_{};
  int board_ = 0;
  bool flat_field_ = false;
  std::uint64_t exposures_ = 0;
};

}  // namespace lumitexel
