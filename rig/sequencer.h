// Takes the shots that a session still lacks.
//
//   for every missing shot:  lamps off ▸ stage ▸ axes ▸ lamps on ▸ expose ▸ read axes back ▸ commit
//
// Lamps that are already right are not switched and axes that already stand there are not moved. However the run ends,
// by its last shot, a fault or a cancel, all lamps are off and all axes halted afterwards.
#pragma once

#include <cstdint>
#include <stop_token>
#include <vector>

#include "rig/progress.h"
#include "rig/rig_devices.h"
#include "rig/session_store.h"

namespace lumitexel {

// An axis that reports a position further than this from where it was sent is at fault.
inline constexpr double kAxisTolerance_deg = 0.5;

// How often a shot is tried before the capture stops.
inline constexpr int kShotAttempts = 3;

struct SequenceSummary {
  std::int64_t shots = 0;  // taken now
  double seconds = 0;      // on the rig's clock
};

// Each frame is committed before the next shot begins, so that a stop at any moment loses at most the shot in progress.
// Begin, end and faults are logged as events of the session, frames that the camera discarded as discards. Throws what
// the devices and the store throw, Protocol for a frame that is not of the camera's size or an axis that stands
// elsewhere, Error where an operator has to change what stands before the camera (rig/stage.h), Cancelled once stop is
// requested.
SequenceSummary take_missing_shots(SessionStore& session, RigDevices& devices, Progress& progress,
                                   std::stop_token stop);

// The same for some of the missing shots, in the order given.
SequenceSummary take_shots(SessionStore& session, RigDevices& devices, const std::vector<Shot>& shots,
                           Progress& progress, std::stop_token stop);

}  // namespace lumitexel
