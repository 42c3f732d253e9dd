// A rig and plan small enough to photograph in milliseconds, as the text of their files.
#pragma once

#include <string>

#include "rig/capture_plan.h"
#include "rig/rig_description.h"

namespace lumitexel {

std::string small_rig_toml();   // 6 x 4 pixels, 12 bits, 1 us exposure steps
std::string small_plan_toml();  // 3 views, brackets of 2, 2 darks per exposure
RigDescription small_rig();
CapturePlan small_plan();

// `text` with the first `from` replaced by `to`; fails the test if there is none.
std::string with_replaced(std::string text, const std::string& from, const std::string& to);

}  // namespace lumitexel
