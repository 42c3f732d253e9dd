// Where the point light stood in every view of a captured session: the spheres' measurement and the arm's, merged.
//
// Everything is in the rig's frame as the given camera_from_rig has it. An error of that transform does no harm: the
// spheres measure in the camera's frame, the arm's alignment takes the error up, and what leaves goes back through the
// same transform.
#pragma once

#include <vector>

#include "processing/calibration/calibration_summary.h"
#include "processing/calibration/captured_inputs.h"
#include "processing/calibration/light/arm_alignment.h"
#include "processing/calibration/light/light_position.h"

namespace lumitexel {

struct SessionLights {
  LightSolution spheres;  // in the camera's frame, one entry a view
  ArmAlignment arm;
  std::vector<ArmPrediction> in_rig;  // the best of both, a view
  // What the lights' errors have in common, per axis: an error of the sphere line, which no number of views averages
  // away. Not in the covariances above.
  double shared_sigma_m = 0;
  std::vector<LightSummary> summaries;  // positions in the rig's frame; the caller knows the world's
};

// `spheres` as measure_lights gives it.
SessionLights align_lights(LightSolution spheres, const std::vector<ViewFrames>& views, const CapturePlan& plan,
                           const RigDescription& rig, const Eigen::Isometry3d& camera_from_rig);

double per_axis_sigma(const Eigen::Matrix3d& covariance);

}  // namespace lumitexel
