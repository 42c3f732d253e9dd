#include "rig/console/output_file.h"

#include <unistd.h>

#include <system_error>

#include "drivers/error.h"

namespace lumitexel {

void require_writable_folder(const std::string& option, const std::filesystem::path& file) {
  if (file.empty()) return;
  std::error_code unreadable;
  if (std::filesystem::is_directory(file, unreadable)) throw BadInput(option, file.string() + " is a folder", "a file in it, or elsewhere");
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  if (!std::filesystem::is_directory(folder, unreadable) || access(folder.c_str(), W_OK) != 0) {
    throw BadInput(option, folder.string() + " is no folder that can be written to", "a file in a folder that is there");
  }
}

PendingDirectory pending_output(const std::string& option, const std::filesystem::path& folder) try {
  return PendingDirectory(folder);
} catch (const Error& error) {
  throw BadInput(option, error.what(), "a place that can be written to");
}

}  // namespace lumitexel
