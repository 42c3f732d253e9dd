// A rig's measured description: a file that builds on the rig's own (rig/rig_file.h) and states what was measured.
#pragma once

#include <string>

#include "rig/commission/commission_report.h"
#include "rig/rig_description.h"

namespace lumitexel {

// base: the path to write into `base`, relative to the file or absolute. What was not measured is left as the base has it.
// Settle times are the measured ones with a fifth added, and never below 0.05 s; comments give each sigma.
std::string measured_rig_toml(const CommissionReport& report, const RigDescription& rig, const std::string& base);

}  // namespace lumitexel
