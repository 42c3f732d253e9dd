#include "rig/pending_directory.h"

#include <unistd.h>

#include <string>
#include <system_error>

#include "drivers/error.h"
#include "rig/durable_file.h"
#include "rig/replace_directory.h"

namespace lumitexel {

namespace fs = std::filesystem;

PendingDirectory::PendingDirectory(const fs::path& target) : target_(fs::absolute(target).lexically_normal()) {
  if (target_.filename().empty()) target_ = target_.parent_path();  // "session/"
  const fs::path parent = target_.parent_path();
  std::error_code failure;
  for (fs::path at = parent; !fs::exists(at, failure) && at != at.parent_path(); at = at.parent_path()) {
    made_parents_.push_back(at);
  }
  // No other living process has our number: what is there under that name was left by one that was killed.
  path_ = parent / ("." + target_.filename().string() + ".partial-" + std::to_string(getpid()));
  fs::remove_all(path_, failure);
  fs::create_directories(path_, failure);
  if (failure) throw Error(path_.string() + ": cannot be made: " + failure.message());
}

PendingDirectory::~PendingDirectory() {
  if (in_place_) return;
  std::error_code ignored;
  fs::remove_all(path_, ignored);
  for (const fs::path& parent : made_parents_) fs::remove(parent, ignored);  // only if empty
}

void PendingDirectory::move_into_place() {
  std::error_code failure;
  fs::rename(path_, target_, failure);
  if (failure) throw Error(target_.string() + ": cannot be put in place: " + failure.message());
  in_place_ = true;
  sync_directory(target_.parent_path());
}

void PendingDirectory::replace_target() {
  replace_directory(path_, target_);
  in_place_ = true;
  sync_directory(target_.parent_path());
}

}  // namespace lumitexel
