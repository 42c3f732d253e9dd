// One motorised axis: a turntable, or one joint of a light positioner.
#pragma once

#include <stop_token>
#include <string>

namespace lumitexel {

struct AxisLimits {
  double min = 0.0, max = 0.0;      // in the axis's own unit
  double speed = 0.0;               // units per second, for time estimates
  double settle_s = 0.0;            // standing still for this long counts as arrived
  bool wraps = false;               // a turntable: positions are equal modulo max - min
  std::string unit = "deg";         // "deg" or "m"
};

class Axis {
 public:
  virtual ~Axis() = default;

  virtual std::string name() const = 0;
  virtual AxisLimits limits() const = 0;
  virtual double position() const = 0;  // as read from the device, in limits().unit

  // Moves and returns when the target is reached and the axis has stood still for settle_s.
  // Throws OutOfRange (before moving), Timeout, Disconnected, Protocol, Cancelled.
  virtual void move_to(double target, std::stop_token stop) = 0;

  // Stops at once; never throws.
  virtual void halt() noexcept = 0;
};

}  // namespace lumitexel
