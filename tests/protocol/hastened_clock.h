// The machine's clock, run faster: for a simulated bench that real clients talk to in real time, and that must not
// take a minute for a turn of its table.
#pragma once

#include "drivers/clock.h"

namespace lumitexel {

class HastenedClock final : public Clock {
 public:
  // factor > 0: bench seconds per second.
  explicit HastenedClock(double factor) : factor_(factor), start_s_(real_.now_s()), start_utc_ns_(real_.utc_ns()) {}
  double now_s() const override { return factor_ * (real_.now_s() - start_s_); }
  std::int64_t utc_ns() const override { return start_utc_ns_ + static_cast<std::int64_t>(now_s() * 1e9); }
  void sleep_until(double deadline_s, std::stop_token stop) override {
    real_.sleep_until(start_s_ + deadline_s / factor_, stop);
  }

 private:
  SystemClock real_;
  double factor_, start_s_;
  std::int64_t start_utc_ns_;
};

}  // namespace lumitexel
