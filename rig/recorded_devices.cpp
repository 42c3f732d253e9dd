#include "rig/recorded_devices.h"

#include <utility>

#include "rig/recorded_bench.h"

namespace lumitexel {
namespace {

using Bench = std::shared_ptr<RecordedBench>;

class RecordedAxisDevice final : public Axis {
 public:
  RecordedAxisDevice(Bench bench, std::string name, RecordedAxis axis)
      : Axis(bench->clock()), bench_(std::move(bench)), name_(std::move(name)), axis_(axis) {}
  std::string name() const override { return name_; }
  AxisLimits limits() const override { return bench_->limits(axis_); }
  void halt() noexcept override {}

 protected:
  void start(double target, std::stop_token) override { bench_->send(axis_, target); }
  AxisReading read() const override { return {bench_->reading(axis_), false, {}}; }

 private:
  Bench bench_;
  std::string name_;
  RecordedAxis axis_;
};

class RecordedLamp final : public Lamp {
 public:
  RecordedLamp(const Bench& bench, std::string name, bool Lighting::*lamp)
      : Lamp(bench->clock(), 0.0), bench_(bench), name_(std::move(name)), lamp_(lamp) {}
  std::string name() const override { return name_; }
  bool is_on() const override { return bench_->lamps().*lamp_; }
  void force_off() noexcept override { bench_->lamps().*lamp_ = false; }

 protected:
  void command(bool on, std::stop_token) override { bench_->lamps().*lamp_ = on; }

 private:
  Bench bench_;
  std::string name_;
  bool Lighting::*lamp_;
};

class RecordedCamera final : public Camera {
 public:
  explicit RecordedCamera(Bench bench) : bench_(std::move(bench)) {}
  std::string name() const override { return bench_->camera_name(); }
  CameraLimits limits() const override { return bench_->camera_limits(); }

 protected:
  CameraSettings arm(const CameraSettings& settings, std::stop_token) override { return armed_ = settings; }
  Frame trigger(std::uint64_t frame_key, std::stop_token stop) override {
    return bench_->expose(armed_, frame_key, stop);
  }

 private:
  Bench bench_;
  CameraSettings armed_;
};

class RecordedStage final : public StageHand {
 public:
  explicit RecordedStage(Bench bench) : bench_(std::move(bench)) {}
  void place(const Prop& prop, std::stop_token) override { bench_->place(prop); }

 private:
  Bench bench_;
};

}  // namespace

RigDevices make_recorded_devices(std::shared_ptr<const SessionStore> recording, RecordedRun run) {
  const Bench bench = std::make_shared<RecordedBench>(std::move(recording), std::move(run));
  const auto axis = [&](const char* name, RecordedAxis which) {
    return std::make_unique<RecordedAxisDevice>(bench, name, which);
  };
  const auto lamp = [&](const char* name, bool Lighting::*which) {
    return std::make_unique<RecordedLamp>(bench, name, which);
  };
  RigDevices devices;
  devices.clock = bench->clock();
  devices.camera = std::make_unique<RecordedCamera>(bench);
  devices.turntable = axis("recorded turntable", RecordedAxis::Turntable);
  devices.light_azimuth = axis("recorded light azimuth", RecordedAxis::LightAzimuth);
  devices.light_elevation = axis("recorded light elevation", RecordedAxis::LightElevation);
  devices.point_light = lamp("recorded point light", &Lighting::point);
  devices.ring_flash = lamp("recorded ring flash", &Lighting::ring);
  devices.backlight = lamp("recorded backlight", &Lighting::back);
  devices.stage = std::make_unique<RecordedStage>(bench);
  return devices;
}

}  // namespace lumitexel
