// The time of a recording: it goes on as somebody sleeps, and with every frame it is the frame's.
#pragma once

#include "drivers/clock.h"

namespace lumitexel {

// One thread plays a recording; others may read.
class RecordedClock final : public Clock {
 public:
  explicit RecordedClock(std::int64_t start_utc_ns) : utc_at_zero_ns_(start_utc_ns) {}
  double now_s() const override { return monotonic_.now_s(); }
  std::int64_t utc_ns() const override { return utc_at_zero_ns_ + elapsed_ns(); }
  void sleep_until(double deadline_s, std::stop_token stop) override { monotonic_.sleep_until(deadline_s, stop); }

  // From now on it is this time, to the nanosecond. Where that is later than it was, now_s() has gone on as much.
  void set_utc(std::int64_t utc, std::stop_token stop) {
    const std::int64_t forward_ns = utc - utc_ns();
    if (forward_ns > 0) sleep_until(now_s() + static_cast<double>(forward_ns) * 1e-9, stop);
    utc_at_zero_ns_ = utc - elapsed_ns();
  }

 private:
  std::int64_t elapsed_ns() const { return static_cast<std::int64_t>(monotonic_.now_s() * 1e9); }
  VirtualClock monotonic_{0};
  std::atomic<std::int64_t> utc_at_zero_ns_;
};

}  // namespace lumitexel
