// From what to photograph to the list of single exposures, in the order of shooting.
#pragma once

#include <string>
#include <vector>

#include "rig/capture_plan.h"
#include "rig/rig_description.h"
#include "rig/shot.h"

namespace lumitexel {

// For the lens, with the turntable at 0: the board placement by placement (after the first one the lamp's pattern), then
// the flat fields. Per view, in a short order (rig/view_order.h): silhouette, spheres_ring, spheres_point, the object's bracket. The gray
// card's bracket follows the view whose light stands nearest to the card's. Last, with no axis moved any more,
// darks_per_exposure darks for every exposure time used before. Exposures are quantised to what the camera can do.
// The same plan and rig always give the same shots.
//
// Throws BadInput naming `plan_where` and the key if the rig cannot do what the plan wants: an exposure outside the
// camera's limits, two exposures of a bracket that become one, a light position out of the positioner's reach, a board
// that the rig has not.
std::vector<Shot> schedule_shots(const CapturePlan& plan, const RigDescription& rig, const std::string& plan_where);

}  // namespace lumitexel
