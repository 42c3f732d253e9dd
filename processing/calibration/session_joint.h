// The last step of a captured session's geometry: lights from all highlights, and what these say of the lens and so of the poses.
#pragma once

#include "processing/calibration/calibration_options.h"
#include "processing/calibration/calibration_summary.h"
#include "processing/calibration/captured_inputs.h"
#include "processing/calibration/light/sphere_shots.h"
#include "processing/calibration/session_lens.h"
#include "processing/calibration/session_poses.h"

namespace lumitexel {

// Every view's light. Lens and poses are changed (pose/joint_refinement.h) if that lowers chi square of highlights and prior
// together by more than chance does in 20 sessions; if not, both stay, and lights get only the lens's share of their
// uncertainty. Without the step, or with a lens whose error nobody stated, lights are solved with the lens as it is.
// Fills in summary.joint, and summary.lens and summary.poses where they change.
LightSolution refine_jointly(const SphereHighlights& seen, const CapturedInputs& in, const CalibrationOptions& options,
                             SessionLens& lens, SessionPoses& poses, CalibrationSummary& summary);

}  // namespace lumitexel
