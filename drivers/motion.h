// One motorised axis: a turntable, or one joint of a light positioner.
//
// A driver starts a motion and reads where the axis is; that a motion has ended is judged here, the same way for all:
// the target is reached and the axis has stood still there for its settle time.
#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>

#include "drivers/clock.h"

namespace lumitexel {

struct AxisLimits {
  double min = 0.0, max = 0.0;      // in the axis's own unit
  double speed = 0.0;               // units per second, for time estimates and deadlines
  double settle_s = 0.0;            // standing still for this long counts as arrived
  bool wraps = false;               // a turntable: positions are equal modulo max - min
  std::string unit = "deg";         // "deg" or "m"
  double tolerance = 0.01;          // standing within this of the target is being there
  double grace_s = 2.0;             // a motion may take half as long again as its way needs, and so much more
};

// |a - b|, the short way round for an axis that wraps.
double distance_between(const AxisLimits& limits, double a, double b);

struct AxisReading {
  double position = 0.0;            // in limits().unit
  bool moving = false;              // false where the device cannot tell; the position has to stand still anyway
  std::string fault;                // what the device complains of; empty if nothing
};

class Axis {
 public:
  explicit Axis(std::shared_ptr<Clock> clock) : clock_(std::move(clock)) {}
  virtual ~Axis() = default;

  virtual std::string name() const = 0;
  virtual AxisLimits limits() const = 0;

  // As read from the device. Throws Timeout, Disconnected, Protocol.
  double position() const { return read().position; }

  // Moves and returns when the target is reached and the axis has stood still for settle_s; does not move if it stands
  // there already. Throws OutOfRange (before moving), Timeout if it does not arrive in time, Disconnected, Protocol for a
  // fault that the device reports, Cancelled. Whenever it throws after the start, the axis has been halted.
  void move_to(double target, std::stop_token stop);

  // Stops at once; never throws.
  virtual void halt() noexcept = 0;

 protected:
  Clock& clock() const { return *clock_; }
  // Starts the motion to a target inside the limits and does not wait for it.
  virtual void start(double target, std::stop_token stop) = 0;
  virtual AxisReading read() const = 0;

 private:
  double place_of(double target) const;
  void wait_for_arrival(double place, double way, std::stop_token stop);
  void wait_for_rest(double place, double deadline_s, std::stop_token stop);
  AxisReading checked_reading() const;
  [[noreturn]] void fail_arriving(double place, double position) const;

  std::shared_ptr<Clock> clock_;
};

}  // namespace lumitexel
