// A run of the sequencer under the eyes of the safety lane, where the rig has one. However the run ends, all lamps are
// off and all axes halted afterwards; if that could not be had, the error says so before anything else.
#pragma once

#include <functional>
#include <stop_token>
#include <string>

#include "rig/rig_devices.h"

namespace lumitexel {

// How every error begins that leaves a lamp or an axis unaccounted for.
inline constexpr const char* kNotSafe = "NOT SAFE:";

class GuardedRun {
 public:
  // stop: the caller's. Its stop trips the lane at once, from the thread that requests it; a trip of the lane stops the run.
  GuardedRun(RigDevices& devices, std::stop_token stop);
  // What finish() or abandon() has not done.
  ~GuardedRun();
  GuardedRun(const GuardedRun&) = delete;
  GuardedRun& operator=(const GuardedRun&) = delete;

  // Set by the caller's stop and by a trip.
  std::stop_token stop() const { return halt_.get_token(); }
  void expect_life_within(double seconds, const std::string& doing);  // SafetyLane's

  // After the last shot: dark and still, through the lane as well, which watches again afterwards. Throws Error, naming
  // them, if controllers have not acknowledged.
  void finish();

  // After a fault: dark and still through the lane, then through the devices themselves. Returns what to tell: the lane's
  // cause if it tripped first, else `what`; and which controllers have not acknowledged.
  std::string abandon(const std::string& what);
  // Inside a catch: throws the exception being handled if `cause` is its text, else Error with the cause.
  [[noreturn]] void rethrow_or_explain(const std::string& cause) const;

 private:
  void force_dark_and_still() noexcept;

  RigDevices& devices_;
  std::stop_source halt_;
  std::stop_callback<std::function<void()>> on_stop_;
  bool ended_ = false;
};

}  // namespace lumitexel
