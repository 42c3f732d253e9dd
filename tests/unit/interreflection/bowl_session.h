// Photographs of the bowl (bowl.h), of albedo kSphereAlbedo and evenly matte, from eight sides.
#pragma once

#include "processing/calibration/calibrated_session.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {

// With the light that comes by way of up to so many other surfaces; 0: a world that has none.
CalibratedSession photographed_bowl(int bounces, const TemporaryFolder& folder);

}  // namespace lumitexel
