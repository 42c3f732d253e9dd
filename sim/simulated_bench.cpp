#include "sim/simulated_bench.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/seeded_random.h"
#include "sim/session_drift.h"
#include "sim/state_strip.h"

namespace lumitexel {
namespace {

template <class Enum>
std::size_t index_of(Enum value) {
  return static_cast<std::size_t>(value);
}

double wrapped(const AxisLimits& limits, double place) {
  const double turn = limits.max - limits.min;
  const double inside = place - turn * std::floor((place - limits.min) / turn);
  return inside >= limits.max ? limits.min : inside;
}

// From `from` to `to` the way the axis goes: the short way round if it wraps.
double signed_way(const AxisLimits& limits, double from, double to) {
  return limits.wraps ? std::remainder(to - from, limits.max - limits.min) : to - from;
}

}  // namespace

const char* to_string(BenchAxis axis) {
  constexpr std::array<const char*, 3> kNames{"turntable", "light azimuth", "light elevation"};
  return kNames[index_of(axis)];
}

const char* to_string(BenchLamp lamp) {
  constexpr std::array<const char*, 3> kNames{"point light", "ring flash", "backlight"};
  return kNames[index_of(lamp)];
}

SimulatedBench::SimulatedBench(const RigDescription& rig, const BenchBehaviour& behaviour, std::shared_ptr<Clock> clock,
                               PixelSource pixels)
    : camera_(rig.camera), behaviour_(behaviour), clock_(std::move(clock)), pixels_(std::move(pixels)) {
  const LightPositionerDescription& arm = rig.light_positioner;
  const auto set = [this](BenchAxis axis, double min, double max, double speed, double settle_s, bool wraps) {
    AxisModel& model = axes_[index_of(axis)];
    model.limits.min = min;
    model.limits.max = max;
    model.limits.speed = speed;
    model.limits.settle_s = settle_s;
    model.limits.wraps = wraps;
    model.from = model.target = std::clamp(0.0, min, max);
    model.start_s = clock_->now_s();
  };
  set(BenchAxis::Turntable, 0.0, 360.0, rig.turntable.speed_deg_per_s, rig.turntable.settle_s, true);
  set(BenchAxis::LightAzimuth, arm.azimuth_min_deg, arm.azimuth_max_deg, arm.speed_deg_per_s, arm.settle_s, false);
  set(BenchAxis::LightElevation, arm.elevation_min_deg, arm.elevation_max_deg, arm.speed_deg_per_s, arm.settle_s, false);
}

AxisLimits SimulatedBench::limits(BenchAxis axis) const { return axes_[index_of(axis)].limits; }

BenchMotion SimulatedBench::motion_of(const AxisModel& axis, double now_s) const {
  const double way = signed_way(axis.limits, axis.from, axis.target);
  const double gone = axis.limits.speed * (now_s - axis.start_s);
  // 1e-9 of a unit: an arrival time that was rounded down is still an arrival.
  if (axis.jammed) return {axis.from, axis.target, false};
  if (gone >= std::abs(way) - 1e-9) return {axis.target, axis.target, false};
  const double place = axis.from + std::copysign(gone, way);
  return {axis.limits.wraps ? wrapped(axis.limits, place) : place, axis.target, true};
}

void SimulatedBench::start_move(BenchAxis which, double target) {
  const std::lock_guard lock(mutex_);
  AxisModel& axis = axes_[index_of(which)];
  const double now_s = clock_->now_s();
  axis.from = motion_of(axis, now_s).position;
  axis.target = axis.limits.wraps ? wrapped(axis.limits, target) : std::clamp(target, axis.limits.min, axis.limits.max);
  axis.start_s = now_s;
  const double way = signed_way(axis.limits, axis.from, axis.target);
  // Half the slack either side, by the direction that it was last driven in.
  if (way != 0.0 && behaviour_.turntable_backlash_deg != 0.0) {
    axis.rest_offset = -std::copysign(0.5 * behaviour_.turntable_backlash_deg, way);
  }
}

void SimulatedBench::halt(BenchAxis which) {
  const std::lock_guard lock(mutex_);
  AxisModel& axis = axes_[index_of(which)];
  const double now_s = clock_->now_s();
  const BenchMotion motion = motion_of(axis, now_s);
  if (!motion.moving) return;
  axis.from = axis.target = motion.position;
  axis.start_s = now_s;
}

BenchMotion SimulatedBench::motion(BenchAxis axis) const {
  const std::lock_guard lock(mutex_);
  return motion_of(axes_[index_of(axis)], clock_->now_s());
}

void SimulatedBench::switch_lamp(BenchLamp lamp, bool on) {
  const std::lock_guard lock(mutex_);
  lit_[index_of(lamp)] = on;
}

bool SimulatedBench::is_lit(BenchLamp lamp) const {
  const std::lock_guard lock(mutex_);
  return lit_[index_of(lamp)] && !broken_[index_of(lamp)];
}

void SimulatedBench::jam(BenchAxis which, bool jammed) {
  const std::lock_guard lock(mutex_);
  AxisModel& axis = axes_[index_of(which)];
  const double now_s = clock_->now_s();
  axis.from = motion_of(axis, now_s).position;
  if (!jammed && axis.jammed) axis.target = axis.from;
  axis.start_s = now_s;
  axis.jammed = jammed;
}

void SimulatedBench::break_lamp(BenchLamp lamp, bool broken) {
  const std::lock_guard lock(mutex_);
  broken_[index_of(lamp)] = broken;
}

void SimulatedBench::place(int board, bool flat_field) {
  const std::lock_guard lock(mutex_);
  board_ = board;
  flat_field_ = flat_field;
}

double SimulatedBench::true_turntable_deg(double now_s) const {
  const AxisModel& axis = axes_[index_of(BenchAxis::Turntable)];
  double place = motion_of(axis, now_s).position + axis.rest_offset;
  const double arrival_s =
      axis.start_s + std::abs(signed_way(axis.limits, axis.from, axis.target)) / axis.limits.speed;
  if (behaviour_.turntable_swing_deg != 0.0 && now_s > arrival_s && axis.from != axis.target) {
    const double since_s = now_s - arrival_s;
    place += behaviour_.turntable_swing_deg * std::exp(-since_s / behaviour_.turntable_swing_decay_s) *
             std::cos(2.0 * std::numbers::pi * behaviour_.turntable_swing_hz * since_s);
  }
  return wrapped(axis.limits, place);
}

WorldState SimulatedBench::state_at(double now_s) const {
  const auto position = [&](BenchAxis axis) { return motion_of(axes_[index_of(axis)], now_s).position; };
  const auto lit = [&](BenchLamp lamp) { return lit_[index_of(lamp)] && !broken_[index_of(lamp)]; };
  return {true_turntable_deg(now_s),  position(BenchAxis::LightAzimuth), position(BenchAxis::LightElevation),
          lit(BenchLamp::Point),      lit(BenchLamp::Ring),              lit(BenchLamp::Back),
          board_,                     flat_field_};
}

WorldState SimulatedBench::state() const {
  const std::lock_guard lock(mutex_);
  return state_at(clock_->now_s());
}

// All that a frame depends on, and nothing that a restart would change.
std::uint64_t SimulatedBench::noise_key(const CameraSettings& settings, const WorldState& state,
                                        std::uint64_t frame_key) const {
  std::uint64_t key = extended_key(behaviour_.seed, frame_key);
  for (const double part : {settings.exposure_s, settings.gain_db, state.turntable_deg, state.light_azimuth_deg,
                            state.light_elevation_deg}) {
    key = extended_key(key, part);
  }
  const unsigned lamps = (state.point_light ? 1u : 0u) | (state.ring_flash ? 2u : 0u) | (state.backlight ? 4u : 0u);
  key = extended_key(key, std::uint64_t{lamps});
  if (state.board == 0 && !state.flat_field) return key;
  return extended_key(key, 2 * static_cast<std::uint64_t>(state.board) + (state.flat_field ? 1u : 0u));
}

std::uint64_t SimulatedBench::exposures() const {
  const std::lock_guard lock(mutex_);
  return exposures_;
}

BenchExposure SimulatedBench::expose(const CameraSettings& settings, std::uint64_t frame_key, std::stop_token stop) {
  const double start_s = clock_->now_s();
  clock_->sleep_until(start_s + 0.5 * settings.exposure_s, stop);
  BenchExposure exposure;
  exposure.settings = settings;
  exposure.state = state();
  exposure.state.lamp_strength = lamp_strength_at(behaviour_, frame_key);
  exposure.state.sensor_warming_k = sensor_warming_at(behaviour_, frame_key);
  exposure.frame_key = frame_key;
  clock_->sleep_until(start_s + settings.exposure_s, stop);
  exposure.end_s = start_s + settings.exposure_s;
  {
    const std::lock_guard lock(mutex_);
    exposure.count = ++exposures_;
  }
  exposure.samples = pixels_(exposure.state, settings, noise_key(settings, exposure.state, frame_key));
  if (behaviour_.state_strip) {
    write_state_strip({settings, exposure.state, frame_key, exposure.count}, camera_.limits.bits, exposure.samples);
  }
  return exposure;
}

}  // namespace lumitexel
