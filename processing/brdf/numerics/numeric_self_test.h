// The numerical self-test: kernels and fits at the extremes, one table.
#pragma once

#include <cstddef>
#include <functional>
#include <string>

#include "processing/brdf/numerics/numeric_case.h"

namespace lumitexel {

struct NumericSelfTestOptions {
  std::size_t trials = 20'000;       // random lobes for each row of the kernels
  std::size_t lumitexels = 20'000;   // of the largest scene
};
inline constexpr NumericSelfTestOptions kFullNumericSelfTest{1'000'000, 10'000'000};

// report(part, parts) is called as each part begins, and with (parts, parts) at the end. Call before the process starts threads (trapped_run.h).
NumericCases run_numeric_self_test(const NumericSelfTestOptions& options, const std::function<void(int, int)>& report);
// A line a row, a legend, and of each row that does not judge all of its range how many trials those were and why.
std::string to_table(const NumericCases& cases);

}  // namespace lumitexel
