// What a captured session says of itself before anything is measured: its documents, and which frame is for what.
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/captured_frames.h"
#include "processing/calibration/lens/camera_model.h"
#include "processing/calibration/lens/lens_file.h"
#include "processing/image/linear_sensor.h"
#include "processing/surface/mesh.h"
#include "rig/capture_plan.h"
#include "rig/rig_description.h"

namespace lumitexel {

struct CapturedInputs {
  RigDescription rig;
  CapturePlan plan;
  Mesh mesh;  // empty where the plan has no views
  std::optional<LensRecord> lens;  // calibrated before, as the capture was given it
  CameraModel nominal_camera;      // as the rig's description promises
  LinearSensor nominal_sensor;
};

// The frames of one view.
struct SphereShots {
  FrameRecord ring, point;
};
struct ViewFrames {
  std::vector<FrameRecord> bracket;  // at least one
  FrameRecord silhouette;
  SphereShots spheres;
};

// Throws BadInput naming the document, Corrupt if one is missing.
CapturedInputs read_captured_inputs(const SessionStore& session);
// One entry a view, in the plan's order. Throws BadInput if a view lacks a shot.
std::vector<ViewFrames> frames_of_views(const CapturedFrames& frames, const CapturePlan& plan);

}  // namespace lumitexel
