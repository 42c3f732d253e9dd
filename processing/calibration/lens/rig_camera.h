// The camera that a rig's description promises.
#pragma once

#include "processing/calibration/lens/camera_model.h"
#include "rig/rig_description.h"

namespace lumitexel {

CameraModel camera_model_of(const CameraDescription& camera);

}  // namespace lumitexel
