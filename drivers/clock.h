// Time, injected. Nothing else in the project sleeps or asks what time it is, so that a simulated
// session of hours runs in seconds and always the same way.
#pragma once

#include <atomic>
#include <cstdint>
#include <stop_token>

namespace lumitexel {

class Clock {
 public:
  virtual ~Clock() = default;

  // Monotonic seconds since an arbitrary start.
  virtual double now_s() const = 0;

  // Civil time: nanoseconds since 1970-01-01 UTC.
  virtual std::int64_t utc_ns() const = 0;

  // Returns once now_s() >= deadline_s. Throws Cancelled as soon as stop is requested.
  virtual void sleep_until(double deadline_s, std::stop_token stop) = 0;
};

// The machine's own clock.
class SystemClock final : public Clock {
 public:
  double now_s() const override;
  std::int64_t utc_ns() const override;
  void sleep_until(double deadline_s, std::stop_token stop) override;
};

// A clock that moves only when somebody sleeps on it. Starts at now_s() = 0 and the given civil time.
// Safe to share between threads: whoever sleeps longest moves it furthest.
class VirtualClock final : public Clock {
 public:
  explicit VirtualClock(std::int64_t start_utc_ns = 1'700'000'000'000'000'000) : start_utc_ns_(start_utc_ns) {}
  double now_s() const override { return now_s_.load(); }
  std::int64_t utc_ns() const override;
  void sleep_until(double deadline_s, std::stop_token stop) override;

 private:
  std::int64_t start_utc_ns_;
  std::atomic<double> now_s_ = 0.0;
};

}  // namespace lumitexel
