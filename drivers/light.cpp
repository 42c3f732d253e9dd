#include "drivers/light.h"

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr double kAnswer_s = 1.0;
constexpr double kPoll_s = 0.01;

}  // namespace

void Lamp::switch_to(bool on, std::stop_token stop) {
  if (on && steady_ && is_on()) return;
  // Off is sent whatever the lamp says of itself: a lamp with a fault is switched off all the same.
  if (on && is_on()) {
    clock_->sleep_until(clock_->now_s() + settle_s_, stop);  // an earlier call was cut short before the light was steady
    steady_ = true;
    return;
  }
  steady_ = false;
  command(on, stop);
  const double deadline_s = clock_->now_s() + kAnswer_s;
  while (is_on() != on) {
    if (clock_->now_s() > deadline_s) {
      throw Timeout(name() + ": switched " + (on ? "on" : "off") + ", but still says that it is " + (on ? "off" : "on") +
                    " after a second");
    }
    clock_->sleep_until(clock_->now_s() + kPoll_s, stop);
  }
  clock_->sleep_until(clock_->now_s() + settle_s_, stop);
  steady_ = on;
}

}  // namespace lumitexel
