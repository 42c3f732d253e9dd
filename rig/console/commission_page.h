// What commissioning found, as one offline page: curves to look at beside the numbers.
#pragma once

#include <string>

#include "rig/commission/commission_report.h"
#include "rig/rig_description.h"

namespace lumitexel {

// json: the command's result, carried in the page's data block.
std::string commission_page(const CommissionReport& report, const RigDescription& rig, const std::string& json);

}  // namespace lumitexel
