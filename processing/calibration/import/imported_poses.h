// The given poses, and the given lens, of an imported session held against its masks.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/calibration/calibration_summary.h"
#include "rig/progress.h"

namespace lumitexel {

struct ObjectPixels {
  int width_px = 0, height_px = 0;
  std::vector<std::uint8_t> inside;  // 1 = object
};

// masks: one a view; none for a photograph without. Registers the mesh to all masks' rims at once (pose/register_posed_views.h). A
// pose changes only where its silhouette contradicts it, the lens only where all silhouettes together do, at 5 % each for the session
// as a whole. Without masks nothing is compared: under a point light parts of an object are as dark as what is behind it, so that a photograph
// shows no outline that could be trusted. Fills in summary.poses, lens, shares, rim offset and pose_problem. Views of small
// pictures (under 32 pixels) or with the object's middle behind the camera keep what they have.
void check_given_poses(CalibratedSession& session, const std::vector<std::optional<ObjectPixels>>& masks,
                       const CalibrationOptions& options, CalibrationSummary& summary, Progress& progress);

}  // namespace lumitexel
