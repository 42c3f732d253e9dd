// Where the mesh stands before the camera in every view of a captured session.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "processing/calibration/calibration_options.h"
#include "processing/calibration/calibration_summary.h"
#include "processing/calibration/captured_inputs.h"
#include "processing/calibration/lens/tag_detection.h"
#include "processing/calibration/pose/register_turntable.h"
#include "processing/calibration/radiance_reader.h"
#include "processing/calibration/session_lens.h"
#include "rig/progress.h"

namespace lumitexel {

struct SessionPoses {
  std::vector<Eigen::Isometry3d> camera_from_world;  // by view; world: the mesh's frame
  std::optional<TurntableRegistration> registration;  // empty if it was not tried or did not come to an end
  // The lens as the same least squares has it: with these poses and no others. Only where the lens was not taken as exact.
  std::optional<CameraModel> camera;
  std::optional<LensMatrix> lens_covariance;
  bool replaced = false;   // the registration contradicts the description, and its poses are taken
  bool registered = false;  // false: as the rig's description has it, and nobody knows how well that is
};

// The mesh registered to all silhouettes and the table's tags at once. What comes out replaces the rig's description only if
// it contradicts it (5 % level); else the description stays, with the registration's uncertainty. It stays, too, where the silhouettes
// do not determine the poses (symmetric objects) or the registration does not come to an end; summary.pose_problem then
// says why. Fills in summary.poses.
SessionPoses measure_poses(const CapturedInputs& in, const std::vector<ViewFrames>& views, const RadianceReader& reader,
                           const SessionLens& lens, const std::vector<std::vector<DetectedTag>>& tags,
                           const CalibrationOptions& options, CalibrationSummary& summary, Progress& progress);

}  // namespace lumitexel
