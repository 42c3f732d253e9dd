#include "rig/guarded_run.h"

#include <chrono>
#include <exception>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr std::chrono::milliseconds kAcknowledged{2000};

std::string unsafe_text(const std::vector<std::string>& silent) {
  std::string text = kNotSafe;
  for (const std::string& name : silent) text += " " + name + " has not acknowledged lamps off and axes stopped;";
  return text + " check the rig by eye and use its own switch";
}

}  // namespace

GuardedRun::GuardedRun(RigDevices& devices, std::stop_token stop)
    : devices_(devices), on_stop_(std::move(stop), [this] {
        if (devices_.safety) devices_.safety->trip("stopped by the user");
        halt_.request_stop();
      }) {
  if (!devices_.safety) return;
  devices_.safety->on_trip([halt = halt_]() mutable { halt.request_stop(); });
  if (devices_.safety->is_tripped()) halt_.request_stop();
}

GuardedRun::~GuardedRun() {
  if (!ended_) force_dark_and_still();
  if (!devices_.safety) return;
  devices_.safety->on_trip({});
  devices_.safety->expect_life_within({}, "");
}

void GuardedRun::expect_life_within(double seconds, const std::string& doing) {
  if (devices_.safety) devices_.safety->expect_life_within(std::chrono::duration<double>(seconds), doing);
}

void GuardedRun::finish() {
  ended_ = true;
  if (!devices_.safety) return force_dark_and_still();
  SafetyLane& lane = *devices_.safety;
  lane.on_trip({});
  lane.trip("the run has ended");
  const std::vector<std::string> silent = lane.wait_until_safe(kAcknowledged);
  if (!silent.empty()) throw Error(unsafe_text(silent));
  lane.reset();
  force_dark_and_still();
}

std::string GuardedRun::abandon(const std::string& what) {
  ended_ = true;
  if (!devices_.safety) {
    force_dark_and_still();
    return what;
  }
  SafetyLane& lane = *devices_.safety;
  const std::string tripped_by = lane.cause();
  lane.trip(what);
  const std::vector<std::string> silent = lane.wait_until_safe(kAcknowledged);
  // A controller that does not answer the lane would not answer here either, and take its time over it.
  if (silent.empty()) force_dark_and_still();
  // finish() trips the lane itself, so the lane's cause would hide which controller did not acknowledge it.
  if (what.starts_with(kNotSafe)) return what;
  const std::string cause = tripped_by.empty() ? what : "paused safely: " + tripped_by;
  return silent.empty() ? cause : unsafe_text(silent) + ". Cause: " + cause;
}

void GuardedRun::rethrow_or_explain(const std::string& cause) const {
  try {
    throw;
  } catch (const std::exception& error) {
    if (cause == error.what()) throw;
    // The user's own stop stays what it is to the caller.
    if (dynamic_cast<const Cancelled*>(&error) != nullptr && cause == "paused safely: stopped by the user") throw;
  }
  throw Error(cause);
}

void GuardedRun::force_dark_and_still() noexcept {
  for (Lamp* lamp : {devices_.point_light.get(), devices_.ring_flash.get(), devices_.backlight.get()}) {
    lamp->force_off();
  }
  for (Axis* axis : {devices_.turntable.get(), devices_.light_azimuth.get(), devices_.light_elevation.get()}) {
    axis->halt();
  }
}

}  // namespace lumitexel
