#include "rig/rig_file.h"

#include <algorithm>
#include <sstream>
#include <toml++/toml.h>
#include <vector>

#include "drivers/error.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

toml::table parsed(const std::string& text, const fs::path& file) {
  try {
    return toml::parse(text, file.string());
  } catch (const toml::parse_error& error) {
    throw BadInput(file.string() + ":" + std::to_string(error.source().begin.line), std::string(error.description()),
                   "valid TOML");
  }
}

void lay_over(toml::table& under, const toml::table& over) {
  for (const auto& [key, value] : over) {
    toml::table* inner = under[key].as_table();
    const toml::table* laid = value.as_table();
    if (laid != nullptr && (*laid)["replaces"].value_or(false)) {
      toml::table whole = *laid;
      whole.erase("replaces");
      under.insert_or_assign(key, std::move(whole));
    } else if (inner != nullptr && laid != nullptr) {
      lay_over(*inner, *laid);
    } else {
      under.insert_or_assign(key, value);
    }
  }
}

// Files that a rig names relative to itself: what lies over it may be in another folder.
void make_paths_absolute(toml::table& rig, const fs::path& folder) {
  const auto absolute = [&](const char* table, const char* key) {
    toml::value<std::string>* path = rig[table][key].as_string();
    const bool names_a_file = path != nullptr && !(std::string(key) == "object" && path->get() == "vase");
    if (names_a_file) *path = (folder / path->get()).lexically_normal().string();
  };
  absolute("simulation", "object");
  absolute("recorded", "session");
}

toml::table with_bases(const fs::path& file, std::vector<fs::path> seen) {
  const fs::path whole = fs::weakly_canonical(file);
  if (std::find(seen.begin(), seen.end(), whole) != seen.end()) {
    throw BadInput(file.string() + ": base", "the file builds on itself", "another rig's file");
  }
  seen.push_back(whole);
  toml::table over = parsed(read_whole_file(file), file);
  make_paths_absolute(over, fs::absolute(file).parent_path());
  if (!over.contains("base")) return over;
  const toml::value<std::string>* base = over["base"].as_string();
  if (base == nullptr) throw BadInput(file.string() + ": base", "no text", "a rig's file, relative to this one");
  toml::table under = with_bases(file.parent_path() / base->get(), std::move(seen));
  over.erase("base");
  lay_over(under, over);
  return under;
}

}  // namespace

std::string read_rig_file(const fs::path& file) {
  const std::string text = read_whole_file(file);
  if (!parsed(text, file).contains("base")) return text;
  std::ostringstream merged;
  merged << with_bases(file, {}) << '\n';
  return merged.str();
}

}  // namespace lumitexel
