// Other people's programs on what is written, where config/setup/install_checker.sh has put them.
#pragma once

#include <filesystem>
#include <string>

#define SKIP_WITHOUT_CHECKER(name)                                                                                         \
  if (!has_checker(name))                                                                                                  \
  GTEST_SKIP() << "CHECKER MISSING: run config/setup/install_checker.sh " << (name)                                        \
               << " (needs node and npm); without it this is not tested"

namespace lumitexel {

bool has_checker(const std::string& name);

struct CheckerAnswer {
  bool passed = false;
  std::string said;
};

CheckerAnswer checked_by(const std::string& name, const std::filesystem::path& folder);

}  // namespace lumitexel
