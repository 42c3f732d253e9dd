#include "tests/unit/fake_rig.h"

#include <bit>
#include <cmath>
#include <utility>

#include "drivers/error.h"

namespace lumitexel {
namespace {

using Bench = std::shared_ptr<FakeBench>;

// The bench's clock, shared by everybody.
std::shared_ptr<Clock> clock_of(const Bench& bench) { return {bench, &bench->clock}; }

class FakeAxis final : public Axis {
 public:
  FakeAxis(Bench bench, std::string name, AxisLimits limits, double FakeBench::*position)
      : Axis(clock_of(bench)), bench_(std::move(bench)), name_(std::move(name)), limits_(std::move(limits)),
        position_(position) {}
  std::string name() const override { return name_; }
  AxisLimits limits() const override { return limits_; }
  void halt() noexcept override { ++bench_->halts; }

 protected:
  AxisReading read() const override { return {(*bench_).*position_, false, {}}; }
  void start(double target, std::stop_token) override {
    ++bench_->moves;
    (*bench_).*position_ = target;  // at once; the base waits as long as the way takes
  }

 private:
  Bench bench_;
  std::string name_;
  AxisLimits limits_;
  double FakeBench::*position_;
};

class FakeLamp final : public Lamp {
 public:
  FakeLamp(Bench bench, std::string name, bool FakeBench::*lit)
      : Lamp(clock_of(bench), 0.0), bench_(std::move(bench)), name_(std::move(name)), lit_(lit) {}
  std::string name() const override { return name_; }
  bool is_on() const override { return (*bench_).*lit_; }
  void force_off() noexcept override {
    ++bench_->forced_off;
    (*bench_).*lit_ = false;
  }

 protected:
  void command(bool on, std::stop_token) override {
    ++bench_->switches;
    (*bench_).*lit_ = on;
  }

 private:
  Bench bench_;
  std::string name_;
  bool FakeBench::*lit_;
};

class FakeCamera final : public Camera {
 public:
  FakeCamera(Bench bench, CameraLimits limits) : bench_(std::move(bench)), limits_(limits) {}
  std::string name() const override { return "fake camera"; }
  CameraLimits limits() const override { return limits_; }

 protected:
  CameraSettings arm(const CameraSettings& settings, std::stop_token) override { return armed_ = settings; }
  Frame trigger(std::uint64_t frame_key, std::stop_token stop) override {
    if (bench_->before_exposure) bench_->before_exposure();
    bench_->clock.sleep_until(bench_->clock.now_s() + armed_.exposure_s + limits_.readout_s, stop);
    Frame frame;
    frame.width_px = limits_.width_px;
    frame.height_px = limits_.height_px;
    frame.bits = limits_.bits;
    frame.mosaic = limits_.mosaic;
    frame.reported = armed_;
    frame.device_time_s = bench_->clock.now_s();
    frame.device_frame_id = static_cast<std::uint64_t>(++bench_->frames);
    std::uint64_t state = seen(frame_key);
    for (int i = 0; i < limits_.width_px * limits_.height_px; ++i) {
      state = mixed(state, static_cast<std::uint64_t>(i));
      frame.samples.push_back(static_cast<std::uint16_t>(state >> (64 - limits_.bits)));
    }
    if (bench_->tamper) bench_->tamper(frame);
    return frame;
  }

 private:
  static std::uint64_t mixed(std::uint64_t state, std::uint64_t value) {
    state = (state ^ value) * 0x9e3779b97f4a7c15u;
    return state ^ (state >> 29);
  }
  std::uint64_t seen(std::uint64_t frame_key) const {
    std::uint64_t state = frame_key + 1;
    for (const double value : {armed_.exposure_s, armed_.gain_db, bench_->turntable_deg, bench_->light_azimuth_deg,
                               bench_->light_elevation_deg}) {
      state = mixed(state, std::bit_cast<std::uint64_t>(value));
    }
    for (const bool lit : {bench_->point_light, bench_->ring_flash, bench_->backlight}) state = mixed(state, lit ? 3 : 5);
    return state;
  }

  Bench bench_;
  CameraLimits limits_;
  CameraSettings armed_;
};

}  // namespace

RigDevices make_fake_devices(const RigDescription& rig, const std::shared_ptr<FakeBench>& bench) {
  const LightPositionerDescription& arm = rig.light_positioner;
  const auto arm_limits = [&](double min, double max) {
    return AxisLimits{min, max, arm.speed_deg_per_s, arm.settle_s, false, "deg"};
  };
  RigDevices devices;
  devices.clock = clock_of(bench);
  devices.camera = std::make_unique<FakeCamera>(bench, rig.camera.limits);
  devices.turntable = std::make_unique<FakeAxis>(
      bench, "turntable", AxisLimits{0, 360, rig.turntable.speed_deg_per_s, rig.turntable.settle_s, true, "deg"},
      &FakeBench::turntable_deg);
  devices.light_azimuth = std::make_unique<FakeAxis>(
      bench, "light azimuth", arm_limits(arm.azimuth_min_deg, arm.azimuth_max_deg), &FakeBench::light_azimuth_deg);
  devices.light_elevation =
      std::make_unique<FakeAxis>(bench, "light elevation", arm_limits(arm.elevation_min_deg, arm.elevation_max_deg),
                                 &FakeBench::light_elevation_deg);
  devices.point_light = std::make_unique<FakeLamp>(bench, "point light", &FakeBench::point_light);
  devices.ring_flash = std::make_unique<FakeLamp>(bench, "ring flash", &FakeBench::ring_flash);
  devices.backlight = std::make_unique<FakeLamp>(bench, "backlight", &FakeBench::backlight);
  return devices;
}

}  // namespace lumitexel
