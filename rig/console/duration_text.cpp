#include "rig/console/duration_text.h"

#include <array>
#include <cmath>
#include <cstdio>

namespace lumitexel {

std::string duration_text(double seconds) {
  std::array<char, 48> text{};
  const long long whole = std::llround(seconds);
  if (seconds < 59.95) {
    std::snprintf(text.data(), text.size(), "%.1f s", seconds);
  } else if (whole < 3600) {
    std::snprintf(text.data(), text.size(), "%lld min %02lld s", whole / 60, whole % 60);
  } else {
    std::snprintf(text.data(), text.size(), "%lld h %02lld min", whole / 3600, whole % 3600 / 60);
  }
  return text.data();
}

}  // namespace lumitexel
