// An imported session made ready to fit.
#pragma once

#include <utility>

#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"

namespace lumitexel {

// Reads the documents that import_session stored and writes a RadianceImage for each view to
// derived/calibrated/<key>/STEM.exr unless it is there: variance 0 (unknown), kPixelOutside off the mask,
// kPixelSaturated at the largest code value. Poses and lens are held against the masks (imported_poses.h); lights are taken as given.
// What was found goes to views.json beside the photographs; a second run with the same key only reads. Throws Corrupt for a session that import_session did not write, BadInput
// if a stored file cannot be used.
std::pair<CalibratedSession, CalibrationSummary> calibrate_imported(const SessionStore& session, Progress& progress,
                                                                    const CalibrationOptions& options = {});

}  // namespace lumitexel
