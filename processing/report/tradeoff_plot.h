// Error against seconds, with the Pareto front, as an inline SVG drawing.
#pragma once

#include <string>

#include "processing/fit/tradeoff.h"

namespace lumitexel {

// Held-out clipped error (linear, upwards) against seconds (logarithmic, to the right) of every setting that was measured,
// with bars of one sigma over views where it is known, and the front as steps: what can be had within that time. Empty if
// nothing was measured.
std::string tradeoff_plot(const Tradeoff& tradeoff);

}  // namespace lumitexel
