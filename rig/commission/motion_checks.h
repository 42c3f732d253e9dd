// Slack, repeatability and settling of an axis, as the camera sees them.
#pragma once

#include "rig/commission/test_bench.h"

namespace lumitexel {

// The devices have to be connected with a settle time of zero: what is measured is how long to wait. Leaves the axis
// where it began. Throws what the devices throw, Error where the picture does not show the axis's motion.
// step: of the reference pictures, about what is to be told apart at most; swing: how far to come from.
AxisFindings check_axis(TestBench& bench, Axis& axis, double step, double swing);

}  // namespace lumitexel
