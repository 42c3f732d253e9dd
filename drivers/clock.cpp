#include "drivers/clock.h"

#include <chrono>
#include <condition_variable>
#include <mutex>

#include "drivers/error.h"

namespace lumitexel {

double SystemClock::now_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

std::int64_t SystemClock::utc_ns() const {
  const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::nanoseconds>(since_epoch).count();
}

void SystemClock::sleep_until(double deadline_s, std::stop_token stop) {
  std::mutex mutex;
  std::condition_variable_any wake;
  std::unique_lock lock(mutex);
  const std::chrono::duration<double> remaining(deadline_s - now_s());
  wake.wait_for(lock, stop, remaining, [] { return false; });
  if (stop.stop_requested()) throw Cancelled("wait cancelled");
}

std::int64_t VirtualClock::utc_ns() const {
  return start_utc_ns_ + static_cast<std::int64_t>(now_s_.load() * 1e9);
}

void VirtualClock::sleep_until(double deadline_s, std::stop_token stop) {
  if (stop.stop_requested()) throw Cancelled("wait cancelled");
  double now_s = now_s_.load();
  while (deadline_s > now_s && !now_s_.compare_exchange_weak(now_s, deadline_s)) {
  }
}

}  // namespace lumitexel
