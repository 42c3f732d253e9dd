// From a captured session's raw frames to a session ready to fit.
#pragma once

#include <utility>

#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"
#include "rig/progress.h"
#include "rig/rig_description.h"
#include "rig/session_store.h"

namespace lumitexel {

// Darks, HDR radiance, lights from the spheres and the arm, scale from the gray card, poses from the rig's geometry and
// the turntable as read back, masks from the silhouettes. Photographs (NAME.exr) and views.json go to
// derived/calibrated/<key>; a second run with the same key only reads them. `world` is the turntable's frame.
// Radiance is in DN per second. A view whose spheres tell nothing gets its light from the aligned arm (see the
// summary). Throws BadInput for an unfinished or unusable session, Corrupt for changed files, Error if no spheres are
// found.
std::pair<CalibratedSession, CalibrationSummary> calibrate_captured(const SessionStore& session, Progress& progress,
                                                                       const CalibrationOptions& options = {});

}  // namespace lumitexel
