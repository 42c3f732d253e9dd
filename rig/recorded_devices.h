// A recorded session as if its rig were there: the third backend, beside hardware and the simulation.
#pragma once

#include <memory>

#include "rig/recording.h"
#include "rig/rig_devices.h"

namespace lumitexel {

// Devices that deliver what this part of the recording holds, on its time: samples, settings, device times,
// temperatures and axis readings as recorded, discarded frames and failed attempts before the frame that came in the
// end. What the recording does not hold is refused with OutOfRange (rig/recorded_bench.h). They keep the recording
// open. Throws BadInput for an imported session, Corrupt for one whose rig cannot be read.
RigDevices make_recorded_devices(std::shared_ptr<const SessionStore> recording, RecordedRun run);

}  // namespace lumitexel
