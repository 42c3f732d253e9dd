// Computation with floating-point traps on.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "processing/brdf/numerics/numeric_case.h"

namespace lumitexel {

struct TrappedPart {
  std::string name;
  std::function<void()> run;
};

// Runs the parts in a child process, on one thread, where an invalid operation, a division by zero or an overflow ends the process. The
// row's error is 0 if the child came to its end; else its text names the part in which it did not. To be called before this process
// starts threads of its own.
NumericCase run_trapped(const std::vector<TrappedPart>& parts);

}  // namespace lumitexel
