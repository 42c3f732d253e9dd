#include "rig/pending_directory.h"

#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <string>
#include <system_error>

#include "drivers/error.h"
#include "rig/durable_file.h"
#include "rig/replace_directory.h"

namespace lumitexel {

namespace fs = std::filesystem;

namespace {

// Whether `name` is `prefix` and the number of a process that is no more.
bool is_left_over(const std::string& name, const std::string& prefix) {
  if (!name.starts_with(prefix)) return false;
  pid_t process = 0;
  const char* const end = name.data() + name.size();
  const auto [read, error] = std::from_chars(name.data() + prefix.size(), end, process);
  return error == std::errc() && read == end && process > 0 && kill(process, 0) != 0 && errno == ESRCH;
}

void remove_left_overs(const fs::path& parent, const std::string& prefix) {
  std::error_code ignored;
  for (fs::directory_iterator entry(parent, ignored), end; !ignored && entry != end; entry.increment(ignored)) {
    std::error_code kept;
    if (is_left_over(entry->path().filename().string(), prefix)) fs::remove_all(entry->path(), kept);
  }
}

}  // namespace

PendingDirectory::PendingDirectory(const fs::path& target) : target_(fs::absolute(target).lexically_normal()) {
  if (target_.filename().empty()) target_ = target_.parent_path();  // "session/"
  const fs::path parent = target_.parent_path();
  std::error_code failure;
  for (fs::path at = parent; !fs::exists(at, failure) && at != at.parent_path(); at = at.parent_path()) {
    made_parents_.push_back(at);
  }
  const std::string prefix = "." + target_.filename().string() + ".partial-";
  remove_left_overs(parent, prefix);
  // No other living process has our number: what is there under that name was left by one that was killed.
  path_ = parent / (prefix + std::to_string(getpid()));
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
