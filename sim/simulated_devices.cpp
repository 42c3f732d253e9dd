// The bench's devices in process: the interfaces, and nothing between them and the bench.
#include "sim/seeded_random.h"
#include "sim/simulated_bench.h"
#include "sim/simulated_rig.h"

namespace lumitexel {
namespace {

class SimulatedAxis final : public Axis {
 public:
  SimulatedAxis(std::shared_ptr<SimulatedBench> bench, BenchAxis axis)
      : Axis(bench->clock()), bench_(std::move(bench)), axis_(axis) {}
  std::string name() const override { return to_string(axis_); }
  AxisLimits limits() const override { return bench_->limits(axis_); }
  void halt() noexcept override { bench_->halt(axis_); }

 protected:
  void start(double target, std::stop_token) override { bench_->start_move(axis_, target); }
  AxisReading read() const override {
    const BenchMotion motion = bench_->motion(axis_);
    return {motion.position, motion.moving, {}};
  }

 private:
  std::shared_ptr<SimulatedBench> bench_;
  BenchAxis axis_;
};

class SimulatedLamp final : public Lamp {
 public:
  SimulatedLamp(std::shared_ptr<SimulatedBench> bench, BenchLamp lamp)
      : Lamp(bench->clock(), bench->behaviour().lamp_settle_s), bench_(std::move(bench)), lamp_(lamp) {}
  std::string name() const override { return to_string(lamp_); }
  bool is_on() const override { return bench_->is_lit(lamp_); }
  void force_off() noexcept override { bench_->switch_lamp(lamp_, false); }

 protected:
  void command(bool on, std::stop_token) override { bench_->switch_lamp(lamp_, on); }

 private:
  std::shared_ptr<SimulatedBench> bench_;
  BenchLamp lamp_;
};

class SimulatedCamera final : public Camera {
 public:
  explicit SimulatedCamera(std::shared_ptr<SimulatedBench> bench) : bench_(std::move(bench)) {}
  std::string name() const override { return "simulated camera"; }
  CameraLimits limits() const override { return bench_->camera().limits; }

 protected:
  CameraSettings arm(const CameraSettings& settings, std::stop_token) override { return armed_ = settings; }
  Frame trigger(std::uint64_t frame_key, std::stop_token stop) override {
    BenchExposure exposure = bench_->expose(armed_, frame_key, stop);
    const CameraLimits limit = limits();
    Frame frame;
    frame.width_px = limit.width_px;
    frame.height_px = limit.height_px;
    frame.bits = limit.bits;
    frame.mosaic = limit.mosaic;
    frame.samples = std::move(exposure.samples);
    frame.reported = exposure.settings;
    frame.device_time_s = exposure.end_s;
    frame.sensor_temperature_c = bench_->behaviour().sensor_temperature_c + exposure.state.sensor_warming_k;
    frame.device_frame_id = exposure.count;
    bench_->clock()->sleep_until(exposure.end_s + limit.readout_s, stop);
    return frame;
  }

 private:
  std::shared_ptr<SimulatedBench> bench_;
  CameraSettings armed_;
};

class SimulatedStage final : public StageHand {
 public:
  explicit SimulatedStage(std::shared_ptr<SimulatedBench> bench) : bench_(std::move(bench)) {}
  void place(const Prop& prop, std::stop_token) override {
    bench_->place(prop.placement, prop.kind == Prop::Kind::Diffuser);
  }

 private:
  std::shared_ptr<SimulatedBench> bench_;
};

}  // namespace

RigDevices make_simulated_devices(const std::shared_ptr<SimulatedBench>& bench) {
  RigDevices devices;
  devices.clock = bench->clock();
  devices.camera = std::make_unique<SimulatedCamera>(bench);
  devices.turntable = std::make_unique<SimulatedAxis>(bench, BenchAxis::Turntable);
  devices.light_azimuth = std::make_unique<SimulatedAxis>(bench, BenchAxis::LightAzimuth);
  devices.light_elevation = std::make_unique<SimulatedAxis>(bench, BenchAxis::LightElevation);
  devices.point_light = std::make_unique<SimulatedLamp>(bench, BenchLamp::Point);
  devices.ring_flash = std::make_unique<SimulatedLamp>(bench, BenchLamp::Ring);
  devices.backlight = std::make_unique<SimulatedLamp>(bench, BenchLamp::Back);
  devices.stage = std::make_unique<SimulatedStage>(bench);
  return devices;
}

RigDevices make_simulated_devices(const RigDescription& rig, std::shared_ptr<SimulatedWorld> world) {
  return make_simulated_devices(make_rendered_bench(rig, std::move(world), std::make_shared<VirtualClock>()));
}

}  // namespace lumitexel
