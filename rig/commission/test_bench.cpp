#include "rig/commission/test_bench.h"

#include <algorithm>
#include <cmath>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr int kMostTries = 12;
constexpr double kBetweenFrames_s = 120.0;
constexpr int kAttempts = 10;  // a camera may be several frames late with its settings; that is what is measured

}  // namespace

TestBench::TestBench(RigDevices& devices, const RigDescription& rig, std::stop_token stop)
    : devices_(devices), rig_(rig), stop_(std::move(stop)) {
  devices_.camera->on_discard([this](const DiscardedFrame& frame) {
    if (frame.reported) ++late_frames_;
  });
}

TestBench::~TestBench() { devices_.camera->on_discard(nullptr); }

void TestBench::light_only(Lamp* lamp) {
  for (Lamp* other : {devices_.point_light.get(), devices_.ring_flash.get(), devices_.backlight.get()}) {
    if (other != lamp) other->switch_to(false, stop_);
  }
  if (lamp != nullptr) lamp->switch_to(true, stop_);
}

CameraSettings TestBench::settings_for(double exposure_s) const {
  const CameraLimits limits = devices_.camera->limits();
  return devices_.camera->quantised({exposure_s, std::clamp(0.0, limits.gain_min_db, limits.gain_max_db)});
}

Frame TestBench::shoot(double exposure_s) {
  const CameraSettings settings = settings_for(exposure_s);
  // Between two frames lie a few moves and rests at most.
  const double shot_s = devices_.camera->longest_shot_s(settings, kAttempts);
  if (devices_.safety) {
    devices_.safety->expect_life_within(std::chrono::duration<double>(shot_s + kBetweenFrames_s), "a commissioning frame");
  }
  TimedFrame timed;
  timed.shot_s = devices_.clock->now_s();
  Frame frame = devices_.camera->shoot(settings, stop_, ++key_, kAttempts);
  timed.arrived_s = devices_.clock->now_s();
  timed.device_s = frame.device_time_s;
  timed.exposure_s = settings.exposure_s;
  frames_.push_back(timed);
  return frame;
}

Frame TestBench::settled_shot(double exposure_s) {
  const bool changed = frames_.empty() || frames_.back().exposure_s != settings_for(exposure_s).exposure_s;
  for (int i = 0; changed && i < latency_frames_; ++i) shoot(exposure_s);
  return shoot(exposure_s);
}

double TestBench::exposure_for(double share) {
  const CameraLimits limits = devices_.camera->limits();
  const double black = rig_.camera.sensor.black_level_dn;
  double exposure_s = std::clamp(0.01, limits.exposure_min_s, limits.exposure_max_s);
  for (int i = 0; i < kMostTries; ++i) {
    const Frame frame = settled_shot(exposure_s);
    const double reached = (quantile_of(frame.samples, 0.99) - black) / (top_dn() - black);
    if (reached > 0.7 * share && reached < 1.3 * share) return exposure_s;
    const double factor = reached > 0.95 ? 0.1 : std::clamp(share / std::max(reached, 1e-3), 0.1, 20.0);
    const double next_s = std::clamp(exposure_s * factor, limits.exposure_min_s, limits.exposure_max_s);
    if (next_s == exposure_s) break;
    exposure_s = next_s;
  }
  throw Error(devices_.camera->name() + ": no exposure brings the picture to " + std::to_string(share) +
              " of saturation; check lamp, lens cap and aperture");
}

double TestBench::top_dn() const { return std::ldexp(1.0, rig_.camera.limits.bits) - 1.0; }

}  // namespace lumitexel
