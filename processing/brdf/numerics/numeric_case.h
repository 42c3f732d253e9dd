// One row of the numerical self-test.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

namespace lumitexel {

struct NumericCase {
  std::string name;    // "Lafortune double, value, N 1 to 100"
  std::string asked;   // of what the error is a share, and over which range
  double largest = 0;  // error found; infinite where something was no number
  double limit = 0;
  std::size_t excluded = 0;  // trials of the range that are not judged
  std::string because{};     // why not; empty where there are none

  bool ok() const { return largest <= limit; }
};
using NumericCases = std::vector<NumericCase>;

// The largest of many errors; what is no number counts as infinite.
class LargestError {
 public:
  void see(double error) { largest_ = std::isfinite(error) ? std::max(largest_, std::abs(error)) : std::numeric_limits<double>::infinity(); }
  double value() const { return largest_; }

 private:
  double largest_ = 0;
};

}  // namespace lumitexel
