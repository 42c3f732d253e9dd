#include "rig/replace_directory.h"

#include <fcntl.h>
#include <stdio.h>

#include <cerrno>
#include <system_error>

#include "drivers/error.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

void rename_or_throw(const fs::path& from, const fs::path& to, const fs::path& target) {
  std::error_code failure;
  fs::rename(from, to, failure);
  if (failure) throw Error(target.string() + ": cannot be put in place: " + failure.message());
}

// False where the file system has no such step.
bool exchange(const fs::path& fresh, const fs::path& target) {
  if (::renameat2(AT_FDCWD, fresh.c_str(), AT_FDCWD, target.c_str(), RENAME_EXCHANGE) == 0) return true;
  if (errno == EINVAL || errno == ENOSYS) return false;
  throw Error(target.string() + ": cannot be replaced: " + std::error_code(errno, std::generic_category()).message());
}

void set_aside_and_replace(const fs::path& fresh, const fs::path& target) {
  const fs::path old = target.parent_path() / ("." + target.filename().string() + ".replaced");
  std::error_code ignored;
  fs::remove_all(old, ignored);
  rename_or_throw(target, old, target);
  try {
    rename_or_throw(fresh, target, target);
  } catch (const Error&) {
    fs::rename(old, target, ignored);
    throw;
  }
  fs::remove_all(old, ignored);
}

}  // namespace

void replace_directory(const fs::path& fresh, const fs::path& target) {
  std::error_code ignored;
  if (!fs::exists(target, ignored)) return rename_or_throw(fresh, target, target);
  if (!exchange(fresh, target)) return set_aside_and_replace(fresh, target);
  fs::remove_all(fresh, ignored);  // what stood there; the new one stands whether or not it can be removed
}

}  // namespace lumitexel
