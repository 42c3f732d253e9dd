// Files read and written in one piece.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lumitexel {

// All bytes of a file the user named. Throws BadInput naming it if it is missing, not a regular file or unreadable.
std::string read_whole_file(const std::filesystem::path& path);

// Written under a temporary name in the same folder and renamed, so that a reader meets the old file or the new one,
// never a part. Not synced: for what can be computed again. Throws Error, leaving no temporary file behind.
void write_whole_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace lumitexel
