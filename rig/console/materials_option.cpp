#include "rig/console/materials_option.h"

#include <charconv>

#include "drivers/error.h"

namespace lumitexel {

int materials_wanted(const std::string& option, const std::string& text) {
  if (text == "auto") return 0;
  int count = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
  if (error != std::errc() || end != text.data() + text.size() || count < 1 || count > kMostMaterialsAsked) {
    throw BadInput(option, "'" + text + "'", "a whole number from 1 to " + std::to_string(kMostMaterialsAsked) + ", or auto");
  }
  return count;
}

}  // namespace lumitexel
