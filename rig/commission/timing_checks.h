// When settings land, how long a frame takes, and how the camera's clock runs.
#pragma once

#include "rig/commission/test_bench.h"

namespace lumitexel {

// Alternates between two exposures under the point light, and tells from the brightness of each frame, not from what it
// reports, which of them it really had.
TimingFindings check_latency(TestBench& bench);

// From all frames of the commissioning so far.
void check_clock(const TestBench& bench, TimingFindings& found);

}  // namespace lumitexel
