// The sensor of a captured session, measured from the session's own frames, and its darks.
#pragma once

#include "processing/calibration/calibration_options.h"
#include "processing/calibration/calibration_summary.h"
#include "processing/calibration/captured_inputs.h"
#include "processing/calibration/radiance_reader.h"
#include "rig/progress.h"

namespace lumitexel {

// A reader of the session's shots. Noise figures by photon transfer over some of the brackets, a response curve where the
// brackets ask for one; what they cannot tell is the rig's description's. Fills in `summary.sensor` and hot_pixels.
RadianceReader measure_sensor(const CapturedFrames& frames, const CapturedInputs& in,
                              const std::vector<ViewFrames>& views, const CalibrationOptions& options,
                              CalibrationSummary& summary, Progress& progress);

}  // namespace lumitexel
