// Files that survive a power cut, and one writer at a time.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace lumitexel {

// Under which an unfinished file lies: ".NAME.partial" in the same folder.
std::filesystem::path partial_path(const std::filesystem::path& file);

// Writes a temporary file, syncs it, renames it to `file`, syncs the folder; when it returns the bytes are safe. On
// failure nothing is left under either name. Throws StorageFull, or Error with the system's reason.
void write_durably(const std::filesystem::path& file, std::string_view bytes);

// Makes renamed, created and removed entries of a folder safe. Throws Error.
void sync_directory(const std::filesystem::path& directory);

// An exclusive lock on a folder that ends with the object, or with the process however it dies.
class DirectoryLock {
 public:
  // Throws Error at once if another process or object holds it.
  explicit DirectoryLock(const std::filesystem::path& directory);
  ~DirectoryLock();
  DirectoryLock(const DirectoryLock&) = delete;
  DirectoryLock& operator=(const DirectoryLock&) = delete;

 private:
  int descriptor_;
};

}  // namespace lumitexel
