#include "processing/model/model_hashes.h"

#include <nlohmann/json.hpp>

#include "rig/sha256.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;
constexpr const char* kDescription = "model.json";

}  // namespace

std::map<std::string, std::string> file_hashes(const fs::path& directory) {
  std::map<std::string, std::string> hashes;
  for (const fs::directory_entry& entry : fs::directory_iterator(directory)) {
    const std::string name = entry.path().filename().string();
    if (entry.is_regular_file() && name != kDescription) hashes[name] = sha256_hex(read_whole_file(entry.path()));
  }
  return hashes;
}

std::vector<std::string> changed_files(const fs::path& directory) {
  const auto document = nlohmann::json::parse(read_whole_file(directory / kDescription), nullptr, false);
  if (!document.is_object() || !document.contains("sha256") || !document.at("sha256").is_object()) return {};
  std::vector<std::string> changed;
  for (const auto& [name, hash] : document.at("sha256").items()) {
    const fs::path file = directory / name;
    std::error_code unreadable;
    const bool there = fs::is_regular_file(file, unreadable);
    if (!there || nlohmann::json(sha256_hex(read_whole_file(file))) != hash) changed.push_back(name);
  }
  return changed;
}

}  // namespace lumitexel
