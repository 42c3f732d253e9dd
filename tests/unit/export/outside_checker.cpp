#include "tests/unit/export/outside_checker.h"

#include <cstdlib>

#include "rig/whole_file.h"

namespace lumitexel {
namespace {

const std::filesystem::path kRoot = LUMITEXEL_SOURCE_DIR;

std::filesystem::path modules_of(const std::string& name) { return kRoot / "build" / name / "node_modules"; }

}  // namespace

// npm writes the hidden file last, so what it could not finish does not count; nor does another version than the pinned one.
bool has_checker(const std::string& name) {
  const std::filesystem::path installed = kRoot / "build" / name / "package-lock.json";
  const std::filesystem::path pinned = kRoot / "config/setup" / name / "package-lock.json";
  return std::system("command -v node >/dev/null") == 0 && std::filesystem::exists(modules_of(name) / ".package-lock.json") &&
         std::filesystem::exists(installed) && read_whole_file(installed) == read_whole_file(pinned);
}

CheckerAnswer checked_by(const std::string& name, const std::filesystem::path& folder) {
  const std::filesystem::path log = folder / "checker.log";
  const std::string command = "node " + (kRoot / "config/setup" / name / "validate.js").string() + " " + modules_of(name).string() + " " +
                              folder.string() + " >" + log.string() + " 2>&1";
  const bool passed = std::system(command.c_str()) == 0;
  return {passed, read_whole_file(log)};
}

}  // namespace lumitexel
