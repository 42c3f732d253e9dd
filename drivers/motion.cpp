#include "drivers/motion.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr double kPoll_s = 0.02;
constexpr int kLooksWhileSettling = 4;  // at least, so that a slow drift or a swing is seen
constexpr double kSlowMotion = 1.5;     // times the way's time at full speed, for accelerating and braking

}  // namespace

double distance_between(const AxisLimits& limits, double a, double b) {
  return limits.wraps ? std::abs(std::remainder(a - b, limits.max - limits.min)) : std::abs(a - b);
}

void Axis::move_to(double target, std::stop_token stop) {
  const double place = place_of(target);
  const AxisLimits limit = limits();
  const double way = distance_between(limit, checked_reading().position, place);
  // Shorter than half a unit in the last place of any encoder: it stands there, and still.
  if (way <= 1e-9 * std::max(1.0, std::abs(place))) return;
  try {
    start(place, stop);
    wait_for_arrival(place, way, stop);
  } catch (const Error&) {
    halt();
    throw;
  }
}

double Axis::place_of(double target) const {
  const AxisLimits limit = limits();
  double place = target;
  if (limit.wraps && std::isfinite(target)) {
    const double turn = limit.max - limit.min;
    place = target - turn * std::floor((target - limit.min) / turn);
    if (place >= limit.max) place = limit.min;  // rounding can reach max
  }
  if (place >= limit.min && place <= limit.max) return place;
  std::ostringstream text;  // reached for NaN, too
  text << name() << ": position " << target << ' ' << limit.unit << " asked for, the axis goes from " << limit.min
       << " to " << limit.max << ' ' << limit.unit;
  throw OutOfRange(text.str());
}

AxisReading Axis::checked_reading() const {
  AxisReading reading = read();
  if (!reading.fault.empty()) throw Protocol(name() + ": " + reading.fault);
  if (!std::isfinite(reading.position)) throw Protocol(name() + ": reads a position that is not a number");
  return reading;
}

void Axis::wait_for_arrival(double place, double way, std::stop_token stop) {
  const AxisLimits limit = limits();
  const double travel_s = way / limit.speed;
  const double start_s = clock_->now_s();
  const double deadline_s = start_s + kSlowMotion * travel_s + limit.settle_s + limit.grace_s;
  // It cannot be there sooner; a fault that it reports on the way is seen all the same.
  for (double next_s = start_s + kPoll_s; next_s < start_s + travel_s; next_s += std::max(kPoll_s, travel_s / 50.0)) {
    clock_->sleep_until(next_s, stop);
    checked_reading();
  }
  clock_->sleep_until(start_s + travel_s, stop);
  wait_for_rest(place, deadline_s, stop);
}

// Rest is: for settle_s, every look found the axis at its target, not moving, and where the look before found it.
void Axis::wait_for_rest(double place, double deadline_s, std::stop_token stop) {
  const AxisLimits limit = limits();
  const double step_s = limit.settle_s > 0.0 ? std::min(kPoll_s, limit.settle_s / kLooksWhileSettling) : 0.0;
  double resting_since_s = -1.0, rest_position = 0.0;
  for (;;) {
    const AxisReading reading = checked_reading();
    const double now_s = clock_->now_s();
    const bool there = !reading.moving && distance_between(limit, reading.position, place) <= limit.tolerance;
    const bool still = resting_since_s >= 0.0 &&
                       distance_between(limit, reading.position, rest_position) <= limit.tolerance / 2.0;
    if (!there) {
      resting_since_s = -1.0;
    } else if (!still) {
      resting_since_s = now_s;
      rest_position = reading.position;
    }
    // 1e-9: the sum of the steps may fall short of settle_s by rounding.
    if (there && now_s - resting_since_s >= limit.settle_s - 1e-9) return;
    if (now_s > deadline_s) fail_arriving(place, reading.position);
    const double rest_end_s = resting_since_s + limit.settle_s;
    const double next_s = now_s + (there ? step_s : kPoll_s);
    clock_->sleep_until(there ? std::min(next_s, std::max(rest_end_s, now_s)) : next_s, stop);
  }
}

void Axis::fail_arriving(double place, double position) const {
  std::ostringstream text;
  text << name() << ": sent to " << place << ' ' << limits().unit << ", stands at " << position << ' ' << limits().unit
       << " and did not come to rest at its target in time";
  throw Timeout(text.str());
}

}  // namespace lumitexel
