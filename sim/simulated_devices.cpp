#include <cmath>
#include <mutex>
#include <sstream>

#include "drivers/error.h"
#include "sim/render_radiance.h"
#include "sim/seeded_random.h"
#include "sim/sensor.h"
#include "sim/simulated_rig.h"

namespace lumitexel {
namespace {

// What the devices share: the world, its state and its time, behind one lock.
struct SharedBench {
  explicit SharedBench(std::shared_ptr<const SimulatedWorld> built)
      : world(built), renderer(built), sensor(built->rig.camera, built->settings) {}

  std::mutex mutex;
  VirtualClock clock;
  WorldState state;
  std::shared_ptr<const SimulatedWorld> world;
  RadianceRenderer renderer;
  SimulatedSensor sensor;
};

// The clock of all of them; the devices' own waits hold the lock already and use bench->clock itself.
class BenchClock final : public Clock {
 public:
  explicit BenchClock(std::shared_ptr<SharedBench> bench) : bench_(std::move(bench)) {}
  double now_s() const override {
    const std::lock_guard lock(bench_->mutex);
    return bench_->clock.now_s();
  }
  std::int64_t utc_ns() const override {
    const std::lock_guard lock(bench_->mutex);
    return bench_->clock.utc_ns();
  }
  void sleep_until(double deadline_s, std::stop_token stop) override {
    const std::lock_guard lock(bench_->mutex);
    bench_->clock.sleep_until(deadline_s, stop);
  }

 private:
  std::shared_ptr<SharedBench> bench_;
};

class SimulatedAxis final : public Axis {
 public:
  SimulatedAxis(std::shared_ptr<SharedBench> bench, std::string name, AxisLimits limits, double WorldState::*position)
      : bench_(std::move(bench)), name_(std::move(name)), limits_(std::move(limits)), position_(position) {
    bench_->state.*position_ = std::clamp(0.0, limits_.min, limits_.max);
  }

  std::string name() const override { return name_; }
  AxisLimits limits() const override { return limits_; }
  double position() const override {
    const std::lock_guard lock(bench_->mutex);
    return bench_->state.*position_;
  }

  void move_to(double target, std::stop_token stop) override {
    const double place = limits_.wraps ? wrapped(target) : target;
    if (!(place >= limits_.min && place <= limits_.max)) {
      std::ostringstream text;
      text << name_ << ": position " << target << ' ' << limits_.unit << " asked for, the axis goes from "
           << limits_.min << " to " << limits_.max << ' ' << limits_.unit;
      throw OutOfRange(text.str());
    }
    const std::lock_guard lock(bench_->mutex);
    double way = std::abs(place - bench_->state.*position_);
    if (limits_.wraps) way = std::min(way, limits_.max - limits_.min - way);
    if (way == 0.0) return;  // it already stands there, and still
    bench_->clock.sleep_until(bench_->clock.now_s() + way / limits_.speed + limits_.settle_s, stop);
    bench_->state.*position_ = place;
  }

  void halt() noexcept override {}  // every move has ended by the time it returns

 private:
  double wrapped(double target) const {
    const double turn = limits_.max - limits_.min;
    const double place = target - turn * std::floor((target - limits_.min) / turn);
    return place >= limits_.max ? limits_.min : place;  // rounding can reach max; NaN stays
  }

  std::shared_ptr<SharedBench> bench_;
  std::string name_;
  AxisLimits limits_;
  double WorldState::*position_;
};

class SimulatedLamp final : public Lamp {
 public:
  SimulatedLamp(std::shared_ptr<SharedBench> bench, std::string name, bool WorldState::*lit)
      : bench_(std::move(bench)), name_(std::move(name)), lit_(lit) {}

  std::string name() const override { return name_; }
  bool is_on() const override {
    const std::lock_guard lock(bench_->mutex);
    return bench_->state.*lit_;
  }
  void switch_to(bool on, std::stop_token stop) override {
    const std::lock_guard lock(bench_->mutex);
    if (bench_->state.*lit_ == on) return;
    bench_->state.*lit_ = on;
    bench_->clock.sleep_until(bench_->clock.now_s() + bench_->world->settings.lamp_settle_s, stop);
  }
  void force_off() noexcept override {
    try {
      const std::lock_guard lock(bench_->mutex);
      bench_->state.*lit_ = false;
    } catch (const std::system_error&) {  // a mutex that cannot be locked leaves nothing to switch
    }
  }

 private:
  std::shared_ptr<SharedBench> bench_;
  std::string name_;
  bool WorldState::*lit_;
};

class SimulatedCamera final : public Camera {
 public:
  explicit SimulatedCamera(std::shared_ptr<SharedBench> bench) : bench_(std::move(bench)) {}

  std::string name() const override { return "simulated camera"; }
  CameraLimits limits() const override { return bench_->world->rig.camera.limits; }

 protected:
  void arm(const CameraSettings& settings, std::stop_token) override { armed_ = settings; }

  Frame trigger(std::uint64_t frame_key, std::stop_token stop) override {
    const std::lock_guard lock(bench_->mutex);
    const CameraLimits limit = limits();
    bench_->clock.sleep_until(bench_->clock.now_s() + armed_.exposure_s, stop);
    const double exposed_s = bench_->clock.now_s();
    Frame frame;
    frame.width_px = limit.width_px;
    frame.height_px = limit.height_px;
    frame.bits = limit.bits;
    frame.mosaic = limit.mosaic;
    const std::shared_ptr<const Image> radiance = bench_->renderer.render(bench_->state);
    frame.samples = bench_->sensor.expose(*radiance, armed_, noise_key(frame_key));
    frame.reported = armed_;
    frame.device_time_s = exposed_s;
    frame.sensor_temperature_c = bench_->world->settings.sensor_temperature_c;
    frame.device_frame_id = ++frames_;
    bench_->clock.sleep_until(exposed_s + limit.readout_s, stop);
    return frame;
  }

 private:
  // All that a frame depends on, and nothing that a restart would change.
  std::uint64_t noise_key(std::uint64_t frame_key) const {
    const WorldState& state = bench_->state;
    std::uint64_t key = extended_key(bench_->world->settings.seed, frame_key);
    for (const double part : {armed_.exposure_s, armed_.gain_db, state.turntable_deg, state.light_azimuth_deg,
                              state.light_elevation_deg}) {
      key = extended_key(key, part);
    }
    const unsigned lamps = (state.point_light ? 1u : 0u) | (state.ring_flash ? 2u : 0u) | (state.backlight ? 4u : 0u);
    return extended_key(key, std::uint64_t{lamps});
  }

  std::shared_ptr<SharedBench> bench_;
  CameraSettings armed_;
  std::uint64_t frames_ = 0;
};

}  // namespace

RigDevices make_simulated_devices(const RigDescription& rig, std::shared_ptr<SimulatedWorld> world) {
  const auto bench = std::make_shared<SharedBench>(std::move(world));
  const LightPositionerDescription& arm = rig.light_positioner;
  const AxisLimits turntable{0.0, 360.0, rig.turntable.speed_deg_per_s, rig.turntable.settle_s, true, "deg"};
  const AxisLimits azimuth{arm.azimuth_min_deg, arm.azimuth_max_deg, arm.speed_deg_per_s, arm.settle_s, false, "deg"};
  const AxisLimits elevation{arm.elevation_min_deg, arm.elevation_max_deg, arm.speed_deg_per_s, arm.settle_s, false,
                             "deg"};
  RigDevices devices;
  devices.clock = std::make_shared<BenchClock>(bench);
  devices.camera = std::make_unique<SimulatedCamera>(bench);
  devices.turntable = std::make_unique<SimulatedAxis>(bench, "turntable", turntable, &WorldState::turntable_deg);
  devices.light_azimuth =
      std::make_unique<SimulatedAxis>(bench, "light azimuth", azimuth, &WorldState::light_azimuth_deg);
  devices.light_elevation =
      std::make_unique<SimulatedAxis>(bench, "light elevation", elevation, &WorldState::light_elevation_deg);
  devices.point_light = std::make_unique<SimulatedLamp>(bench, "point light", &WorldState::point_light);
  devices.ring_flash = std::make_unique<SimulatedLamp>(bench, "ring flash", &WorldState::ring_flash);
  devices.backlight = std::make_unique<SimulatedLamp>(bench, "backlight", &WorldState::backlight);
  return devices;
}

}  // namespace lumitexel
