// The double and float kernels of every family against 113-bit arithmetic.
#pragma once

#include <cstddef>

#include "processing/brdf/numerics/numeric_case.h"

namespace lumitexel {

// trials: lobes with directions for each row. Errors are shares of max(f, peak / 1000), for slopes of the slope if that is more;
// peak is the value at the lobe's top, for GGX and Ward with the half vector on the normal.
NumericCases double_kernel_cases(std::size_t trials);
NumericCases float_kernel_cases(std::size_t trials);

}  // namespace lumitexel
