// A rig's real devices, connected: camera, axes and lamps through their drivers, and a safety lane with connections of its
// own to every controller.
#pragma once

#include <stop_token>

#include "rig/hardware_description.h"
#include "rig/rig_description.h"
#include "rig/rig_devices.h"

namespace lumitexel {

// Connects everything, switches all lamps off, and homes the axes that do not know where they are: they move. Throws what
// the drivers throw, each naming its device; nothing stays connected then.
RigDevices connect_hardware(const RigDescription& rig, const HardwareDescription& hardware, std::stop_token stop);

}  // namespace lumitexel
