// An imported session made ready to fit.
#pragma once

#include "processing/calibration/calibrated_session.h"

namespace lumitexel {

// Reads the documents that import_session stored and writes a RadianceImage for each view to
// derived/calibrated/<key>/STEM.exr unless it is there: variance 0 (unknown), kPixelOutside off the mask,
// kPixelSaturated at the largest code value. Throws Corrupt for a session that import_session did not write, BadInput
// if a stored file cannot be used.
CalibratedSession calibrate_imported(const SessionStore& session, Progress& progress);

}  // namespace lumitexel
