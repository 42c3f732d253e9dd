// Black level, noise, gain, saturation, dark current and linearity of the camera, from darks and from the point light.
#pragma once

#include "rig/commission/test_bench.h"

namespace lumitexel {

// The point light has to show something of the scene; everything stands still. Throws what the devices throw, Error where
// the scene cannot show what is measured.
SensorFindings check_sensor(TestBench& bench);

}  // namespace lumitexel
