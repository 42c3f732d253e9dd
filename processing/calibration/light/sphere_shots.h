// From all sphere shots of a session to the highlights in them, and from those to the light of every view.
#pragma once

#include <optional>
#include <vector>

#include "processing/calibration/captured_inputs.h"
#include "processing/calibration/light/lamp_size.h"
#include "processing/calibration/light/light_position.h"
#include "processing/calibration/radiance_reader.h"
#include "rig/progress.h"
#include "rig/rig_description.h"

namespace lumitexel {

struct SphereHighlights {
  std::vector<HighlightPixel> rings;                // one a sphere, pooled over the views
  std::vector<std::vector<HighlightPixel>> points;  // by view: the rig's light's
  std::vector<std::vector<std::vector<HighlightPixel>>> strays;  // by view: those of other lights, sorted by light
  SphereLine line;                                  // a start: from the rings alone; fewer spheres than the rig's if not all are seen
  EmitterDisc lamp{};                               // what the points were fitted as
  LampSize size{};                                  // what they say of its radius
};

// One entry a view. How: ring_row.h (which throws Error if too few spheres are seen), point_highlights.h and lamp_size.h. The lamp's
// radius is the rig's file's unless its highlights contradict it: then what they tell, or 0 where they tell no more than a bound.
SphereHighlights read_sphere_highlights(const RadianceReader& reader, const std::vector<SphereShots>& views,
                                        const CameraModel& camera, const RigDescription& rig, Progress& progress);

// solve_lights with what the rig's description says of the ring flash, and the lamp that the highlights were fitted as. In the camera's frame.
LightSolution measure_lights(const SphereHighlights& seen, const CameraModel& camera, const RigDescription& rig,
                             const std::optional<LensMatrix>& lens_covariance = {});

}  // namespace lumitexel
