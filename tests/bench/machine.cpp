#include "tests/bench/machine.h"

#include <ctime>
#include <fstream>
#include <thread>

namespace lumitexel {

std::string cpu_name() {
  std::ifstream info("/proc/cpuinfo");
  std::string line;
  while (std::getline(info, line)) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string utc_date() {
  const std::time_t now = std::time(nullptr);
  char date[32];
  std::strftime(date, sizeof date, "%Y-%m-%d %H:%M", std::gmtime(&now));
  return date;
}

std::string machine_line() {
  std::string line = utc_date() + " UTC, " + cpu_name() + ", " + std::to_string(std::thread::hardware_concurrency()) +
                     " cores";
#ifndef NDEBUG
  line += "\nwarning: a debug build";
#endif
  return line;
}

}  // namespace lumitexel
