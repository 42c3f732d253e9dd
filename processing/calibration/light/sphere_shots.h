// From all sphere shots of a session to the highlights in them, and from those to the light of every view.
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/captured_inputs.h"
#include "processing/calibration/light/light_position.h"
#include "processing/calibration/radiance_reader.h"
#include "rig/progress.h"
#include "rig/rig_description.h"

namespace lumitexel {

struct SphereHighlights {
  std::vector<HighlightPixel> rings;                // one a sphere, pooled over the views
  std::vector<std::vector<HighlightPixel>> points;  // by view
  SphereLine line;                                  // a start: from the rings alone
};

// One entry a view. The spheres stand still, so their ring highlights are pooled over all views (median; a view in
// which the row is not found or stands elsewhere does not count). Throws Error if no view shows the row of spheres.
SphereHighlights read_sphere_highlights(const RadianceReader& reader, const std::vector<SphereShots>& views,
                                        const CameraModel& camera, const RigDescription& rig, Progress& progress);

// solve_lights with what the rig's description says of the ring flash. In the camera's frame.
LightSolution measure_lights(const SphereHighlights& seen, const CameraModel& camera, const RigDescription& rig,
                             const std::optional<LensMatrix>& lens_covariance = {});

}  // namespace lumitexel
