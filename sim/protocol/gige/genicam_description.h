// The GenICam description of the simulated camera: XML that tells any client which features it has, their limits, and
// in which registers (gige_registers.h) they lie.
#pragma once

#include <string>

#include "drivers/camera.h"
#include "sim/protocol/gige/gige_camera_options.h"

namespace lumitexel::gige {

// limits: the whole sensor's.
std::string genicam_description(const CameraLimits& limits, const GigeCameraOptions& options);

// The bounds that the camera has where the rig's description leaves them open.
double lowest_gain_db(const CameraLimits& limits);
double highest_gain_db(const CameraLimits& limits);

}  // namespace lumitexel::gige
