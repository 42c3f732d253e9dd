// What every benchmark prints first.
#pragma once

#include <string>

namespace lumitexel {

std::string cpu_name();      // "Intel(R) …", "unknown"
std::string utc_date();      // "2026-01-31 12:00"
// Date, processor, cores; a warning where it was built to debug.
std::string machine_line();

}  // namespace lumitexel
