#include "rig/console/input_folder.h"

#include <algorithm>
#include <cstdio>
#include <vector>

#include "drivers/error.h"
#include "processing/model/model_file.h"
#include "processing/model/model_hashes.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

constexpr const char* kSessionFile = "session.db";
constexpr const char* kModelFile = "model.json";
constexpr std::size_t kMostNamed = 4;

bool has(const fs::path& folder, const char* file) {
  std::error_code ignored;
  return fs::is_regular_file(folder / file, ignored);
}

std::string listed(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code unreadable;
  for (fs::directory_iterator entry(folder, unreadable), end; !unreadable && entry != end; entry.increment(unreadable)) {
    names.push_back(entry->path().filename().string());
  }
  if (unreadable) return "cannot be read: " + unreadable.message();
  if (names.empty()) return "is an empty folder";
  std::sort(names.begin(), names.end());
  std::string text = "is a folder that holds ";
  for (std::size_t i = 0; i < std::min(kMostNamed, names.size()); ++i) text += (i > 0 ? ", " : "") + names[i];
  return text + (names.size() > kMostNamed ? ", …" : "");
}

void require(const std::string& where, const fs::path& folder, const char* file, const char* expected) {
  if (!has(folder, file)) throw BadInput(where, folder.string() + " " + what_folder_is(folder), expected);
}

}  // namespace

std::string what_folder_is(const fs::path& path) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return "does not exist";
  if (!fs::is_directory(path, ignored)) return "is a file";
  if (has(path, kSessionFile)) return std::string("is a session (it holds a ") + kSessionFile + ")";
  if (has(path, kModelFile)) return std::string("is a model (it holds a ") + kModelFile + ")";
  return listed(path);
}

Model model_given(const std::string& where, const fs::path& folder) {
  require(where, folder, kModelFile, "the folder of a model, as `lumitexel fit` writes it, with a model.json");
  for (const std::string& file : changed_files(folder)) {
    std::fprintf(stderr, "note: %s is not as it was written: its SHA-256 is not the one in model.json, or it is missing; going on with what is there\n", (folder / file).c_str());
  }
  return read_model(folder);
}

SessionStore session_given(const std::string& where, const fs::path& folder, OpenMode mode) {
  require(where, folder, kSessionFile, "the folder of a session, as `lumitexel capture` or `import` makes it, with a session.db");
  return SessionStore::open(folder, mode);
}

}  // namespace lumitexel
