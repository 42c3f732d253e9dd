// The safety lane over the protocols while the session's writer hangs. Figures: tests/bench/safety_latency.
#include <gtest/gtest.h>

#include "tests/protocol/session/frozen_capture.h"

namespace lumitexel {
namespace {

constexpr double kGenerous_ms = 1000.0;  // 100 at the 99.9th percentile is the goal; tests share their machine
constexpr int kTrips = 20;

TEST(SafetyTrip, ArrivesWhileTheWriterHangs) {
  FrozenCapture capture;
  for (int i = 0; i < kTrips; ++i) {
    const TripLatency latency = capture.trip();
    EXPECT_LT(latency.table_ms, kGenerous_ms);
    EXPECT_LT(latency.arm_ms, kGenerous_ms);
    EXPECT_TRUE(capture.is_at_rest());
  }
}

}  // namespace
}  // namespace lumitexel
