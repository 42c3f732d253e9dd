// From positions in metres to a BRDF's value: objects of every size.
#pragma once

#include <cstddef>

#include "processing/brdf/numerics/numeric_case.h"

namespace lumitexel {

// A ball lit and seen from one and a half times its size away, N from 10 to 1e4, near the mirror direction; against 113-bit arithmetic on
// the same positions.
NumericCases scene_cases(std::size_t trials);

}  // namespace lumitexel
