// A folder that comes into being whole or not at all.
#pragma once

#include <filesystem>
#include <vector>

namespace lumitexel {

// A new folder ".NAME.partial-PROCESS" beside `target`; gone again at the object's end, together with any parents that
// were made to hold it, unless it was moved into place. What a killed process leaves is that hidden folder, never half
// a target.
class PendingDirectory {
 public:
  explicit PendingDirectory(const std::filesystem::path& target);  // throws Error if it cannot be made
  ~PendingDirectory();
  PendingDirectory(const PendingDirectory&) = delete;
  PendingDirectory& operator=(const PendingDirectory&) = delete;

  const std::filesystem::path& path() const { return path_; }
  // Renames it to `target`, which must not be there or be an empty folder, and syncs the parent. Throws Error.
  void move_into_place();
  // The same over a folder that holds something and is removed then (replace_directory.h). Throws Error, `target` being as it was.
  void replace_target();

 private:
  std::filesystem::path target_, path_;
  std::vector<std::filesystem::path> made_parents_;  // innermost first
  bool in_place_ = false;
};

}  // namespace lumitexel
