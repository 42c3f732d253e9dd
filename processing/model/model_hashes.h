// Which of a model's files are still as they were written: model.json carries their SHA-256, by name.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace lumitexel {

// Of every file in the folder but model.json, which is to carry them.
std::map<std::string, std::string> file_hashes(const std::filesystem::path& directory);

// Those whose bytes are others than model.json says, or that are missing, in order. Empty where model.json carries no hashes.
std::vector<std::string> changed_files(const std::filesystem::path& directory);

}  // namespace lumitexel
