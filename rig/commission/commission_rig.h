// Measures a connected rig as a lab would before it trusts it.
#pragma once

#include <stop_token>

#include "rig/commission/commission_report.h"
#include "rig/progress.h"
#include "rig/rig_description.h"
#include "rig/rig_devices.h"

namespace lumitexel {

// The description to connect the rig by for commissioning: no settle times, no frames dropped for being late. What these
// have to be is what is measured.
RigDescription commissioning_description(RigDescription rig);

// Something with visible detail has to stand on the turntable, lit by the point light. Lamps are off and axes halted
// afterwards, also after an error. A check whose scene does not allow it is listed in not_checked, with the reason;
// what a device fails by is thrown.
CommissionReport commission_rig(RigDevices& devices, const RigDescription& rig, Progress& progress, std::stop_token stop);

}  // namespace lumitexel
