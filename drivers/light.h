// A switchable lamp: the point light, the ring flash or the backlight.
#pragma once

#include <stop_token>
#include <string>

namespace lumitexel {

class Lamp {
 public:
  virtual ~Lamp() = default;

  virtual std::string name() const = 0;
  virtual bool is_on() const = 0;  // as read from the device

  // Returns once the light is steady. Throws Timeout, Disconnected, Protocol, Cancelled.
  virtual void switch_to(bool on, std::stop_token stop) = 0;

  // Off at once, without waiting; never throws.
  virtual void force_off() noexcept = 0;
};

}  // namespace lumitexel
