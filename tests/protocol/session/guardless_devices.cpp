#include "tests/protocol/session/guardless_devices.h"

namespace lumitexel {
namespace {

// The driver's own verbs, past the base that judges them.
struct CameraVerbs : Camera {
  static CameraSettings arm_of(Camera& camera, const CameraSettings& settings, std::stop_token stop) {
    return (camera.*&CameraVerbs::arm)(settings, std::move(stop));
  }
  static Frame trigger_of(Camera& camera, std::uint64_t key, std::stop_token stop) {
    return (camera.*&CameraVerbs::trigger)(key, std::move(stop));
  }
  static void recover_of(Camera& camera, std::stop_token stop) {
    (camera.*&CameraVerbs::recover)(std::move(stop));
  }
};

struct AxisVerbs : Axis {
  static void start_of(Axis& axis, double target, std::stop_token stop) {
    (axis.*&AxisVerbs::start)(target, std::move(stop));
  }
};

struct LampVerbs : Lamp {
  static void command_of(Lamp& lamp, bool on, std::stop_token stop) {
    (lamp.*&LampVerbs::command)(on, std::move(stop));
  }
};

class CredulousCamera final : public Camera {
 public:
  explicit CredulousCamera(std::unique_ptr<Camera> camera) : camera_(std::move(camera)) {}
  std::string name() const override { return camera_->name(); }
  CameraLimits limits() const override { return camera_->limits(); }

 protected:
  CameraSettings arm(const CameraSettings& settings, std::stop_token stop) override {
    CameraVerbs::arm_of(*camera_, settings, std::move(stop));
    return asked_ = settings;
  }
  Frame trigger(std::uint64_t frame_key, std::stop_token stop) override {
    Frame frame = CameraVerbs::trigger_of(*camera_, frame_key, std::move(stop));
    frame.reported = asked_;
    frame.echoed_key = frame_key;
    frame.device_frame_id = ++frames_;
    frame.device_time_s = static_cast<double>(frames_);
    return frame;
  }
  void recover(std::stop_token stop) override { CameraVerbs::recover_of(*camera_, std::move(stop)); }

 private:
  std::unique_ptr<Camera> camera_;
  CameraSettings asked_;
  std::uint64_t frames_ = 0;
};

class HastyAxis final : public Axis {
 public:
  HastyAxis(std::unique_ptr<Axis> axis, const std::shared_ptr<Clock>& clock)
      : Axis(clock), axis_(std::move(axis)), place_(axis_->position()) {}
  std::string name() const override { return axis_->name(); }
  AxisLimits limits() const override {
    AxisLimits limits = axis_->limits();
    limits.speed = 1e9;
    limits.settle_s = 0.0;
    return limits;
  }
  void halt() noexcept override { axis_->halt(); }

 protected:
  void start(double target, std::stop_token stop) override {
    AxisVerbs::start_of(*axis_, target, std::move(stop));
    place_ = target;
  }
  AxisReading read() const override { return {place_, false, ""}; }

 private:
  std::unique_ptr<Axis> axis_;
  double place_;
};

class TrustingLamp final : public Lamp {
 public:
  TrustingLamp(std::unique_ptr<Lamp> lamp, const std::shared_ptr<Clock>& clock)
      : Lamp(clock, 0.0), lamp_(std::move(lamp)) {}
  std::string name() const override { return lamp_->name(); }
  bool is_on() const override { return on_; }
  void force_off() noexcept override {
    lamp_->force_off();
    on_ = false;
  }

 protected:
  void command(bool on, std::stop_token stop) override {
    LampVerbs::command_of(*lamp_, on, std::move(stop));
    on_ = on;
  }

 private:
  std::unique_ptr<Lamp> lamp_;
  bool on_ = false;
};

}  // namespace

std::unique_ptr<Camera> without_guard(std::unique_ptr<Camera> camera) {
  return std::make_unique<CredulousCamera>(std::move(camera));
}

std::unique_ptr<Axis> without_guard(std::unique_ptr<Axis> axis, const std::shared_ptr<Clock>& clock) {
  return std::make_unique<HastyAxis>(std::move(axis), clock);
}

std::unique_ptr<Lamp> without_guard(std::unique_ptr<Lamp> lamp, const std::shared_ptr<Clock>& clock) {
  return std::make_unique<TrustingLamp>(std::move(lamp), clock);
}

}  // namespace lumitexel
