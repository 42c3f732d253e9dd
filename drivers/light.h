// A switchable lamp: the point light, the ring flash or the backlight.
#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "drivers/clock.h"

namespace lumitexel {

class Lamp {
 public:
  // settle_s: from the moment that the lamp says it is on until its light is steady.
  Lamp(std::shared_ptr<Clock> clock, double settle_s) : clock_(std::move(clock)), settle_s_(settle_s) {}
  virtual ~Lamp() = default;

  virtual std::string name() const = 0;
  // As read from the device: from the lamp's own feedback where it has one. Throws Timeout, Disconnected, Protocol for a
  // fault that it reports.
  virtual bool is_on() const = 0;

  // Returns once the device says so and the light is steady. Throws Timeout if it does not say so within a second,
  // Disconnected, Protocol, Cancelled.
  void switch_to(bool on, std::stop_token stop);

  // Off at once, without waiting; never throws.
  virtual void force_off() noexcept = 0;

 protected:
  // Gives the command and does not wait.
  virtual void command(bool on, std::stop_token stop) = 0;
  Clock& clock() const { return *clock_; }

 private:
  std::shared_ptr<Clock> clock_;
  double settle_s_;
  bool steady_ = false;  // lit by a switch_to() that came to its end
};

}  // namespace lumitexel
