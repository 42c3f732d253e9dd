// From all sphere shots of a session to the light of every view, in the camera's frame.
#pragma once

#include <vector>

#include "processing/calibration/captured_inputs.h"
#include "processing/calibration/radiance_reader.h"
#include "processing/calibration/light/light_position.h"
#include "rig/progress.h"
#include "rig/rig_description.h"

namespace lumitexel {

// One entry a view. The spheres stand still, so their ring highlights are pooled over all views (median; a view in
// which the row is not found or stands elsewhere does not count). Throws Error if no view shows the row of spheres.
LightSolution measure_lights(const RadianceReader& reader, const std::vector<SphereShots>& views,
                             const CameraModel& camera, const RigDescription& rig, Progress& progress);

}  // namespace lumitexel
