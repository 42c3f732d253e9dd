// Lumitexels turned into what the BRDF fits work on.
#pragma once

#include "processing/brdf/observations.h"
#include "processing/calibration/calibrated_session.h"
#include "processing/surface/lumitexel.h"

namespace lumitexel {

// Directions are made in double from positions and views here, with the lumitexels' own normals. Same order as the set,
// without the samples that no fit may meet, which are counted.
Observations observe(const CalibratedSession& session, const LumitexelSet& lumitexels);

}  // namespace lumitexel
