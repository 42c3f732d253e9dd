#include <gtest/gtest.h>

#include <memory>

#include "processing/fit/stage_timer.h"

namespace lumitexel {
namespace {

constexpr std::int64_t kBytes = 96 << 20;

std::int64_t peak_bytes() {
  StageTimer timer;
  timer.begin("now");
  timer.end();
  return timer.stages().front().peak_bytes;
}

// In a vector whose every page is touched.
std::int64_t peak_after_using(std::size_t bytes) {
  const std::vector<char> used(bytes, 1);
  return peak_bytes() + (used.back() - 1);
}

TEST(PeakMemory, StartsAnew) {
  const std::int64_t before = peak_bytes();
  const std::int64_t large = peak_after_using(kBytes);
  ASSERT_GT(large, before + kBytes / 2);
  ASSERT_GE(peak_bytes(), large);  // the peak stays…
  if (!restart_peak_memory()) GTEST_SKIP() << "this system does not let a process reset its peak";
  EXPECT_LT(peak_bytes(), large - kBytes / 2);  // …until it is started anew
}

}  // namespace
}  // namespace lumitexel
