// Seconds for a person to read: "48.2 s", "12 min 05 s", "3 h 07 min".
#pragma once

#include <string>

namespace lumitexel {

std::string duration_text(double seconds);

}  // namespace lumitexel
