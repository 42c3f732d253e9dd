// What a simulated object really looks like in a plan's views: camera, pose and light as they are, and the radiance without noise, lens
// fall-off or drift. A model may be judged by it however the session that it was fitted to was calibrated: a model sits in its mesh's
// frame, and so does the simulation's truth.
#pragma once

#include <vector>

#include "processing/calibration/calibrated_session.h"
#include "processing/image/image.h"
#include "rig/capture_plan.h"
#include "sim/simulated_world.h"
#include "tests/unit/worth/simulated_capture.h"

namespace lumitexel {

struct TrueView {
  View view;                          // without a photograph
  Image radiance;                     // three channels, in the unit of the photographs (samples/s at 0 dB)
  std::vector<std::uint8_t> counted;  // a pixel: 1 where the ray through its centre meets the object
};

// Camera, pose and light of a planned view. For lamps that are points; their pattern and axis are the true ones.
// lamp_strength: against that at the first shot.
View true_view(const SimulatedWorld& world, const PlannedView& planned, double lamp_strength = 1.0);

// Every view of a captured session as it really was, the lamp's drift included; without photographs.
std::vector<View> session_as_it_was(const CapturedWorld& captured);
// Cameras, poses and lights of a calibrated session replaced by those.
void take_truth(CalibratedSession& session, const std::vector<View>& as_it_was);

// Of the given views, held out or not. For cameras of three channels.
std::vector<TrueView> see_truly(const std::shared_ptr<const SimulatedWorld>& world, const std::vector<PlannedView>& planned);

// Views that no plan holds: turntable, the light's azimuth (up to 80 degrees to either side) and the sine of its elevation (up to 65
// degrees) by the first `count` points of a Halton sequence. The same for every world.
std::vector<PlannedView> spread_views(int count);

}  // namespace lumitexel
