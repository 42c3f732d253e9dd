#include "drivers/clock.h"

#include <gtest/gtest.h>

#include "drivers/error.h"

namespace lumitexel {
namespace {

TEST(VirtualClock, MovesOnlyWhenSleptOnAndNeverBack) {
  VirtualClock clock(1'000);
  EXPECT_EQ(clock.now_s(), 0.0);
  clock.sleep_until(3600.0, {});
  EXPECT_EQ(clock.now_s(), 3600.0);
  clock.sleep_until(10.0, {});
  EXPECT_EQ(clock.now_s(), 3600.0);
  EXPECT_EQ(clock.utc_ns(), 1'000 + 3'600'000'000'000);
}

TEST(Clocks, ASleepEndsWhenStopIsRequested) {
  std::stop_source stop;
  stop.request_stop();
  VirtualClock virtual_clock;
  EXPECT_THROW(virtual_clock.sleep_until(1.0, stop.get_token()), Cancelled);
  SystemClock system_clock;
  EXPECT_THROW(system_clock.sleep_until(system_clock.now_s() + 3600.0, stop.get_token()), Cancelled);
}

}  // namespace
}  // namespace lumitexel
