#include "rig/durable_file.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "drivers/error.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void fail(const fs::path& path, const std::string& what) {
  const int cause = errno;
  const std::string text = path.string() + ": " + what + ": " + std::strerror(cause);
  if (cause == ENOSPC || cause == EDQUOT) throw StorageFull(text);
  throw Error(text);
}

class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : path_(path), value_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {
    if (value_ < 0) fail(path, "cannot be opened");
  }
  ~Descriptor() { ::close(value_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write_all(std::string_view bytes) const {
    while (!bytes.empty()) {
      const ssize_t count = ::write(value_, bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count < 0) fail(path_, "cannot be written");
      bytes.remove_prefix(static_cast<std::size_t>(count));
    }
  }
  void sync() const {
    if (::fsync(value_) != 0) fail(path_, "cannot be synced");
  }

 private:
  const fs::path& path_;
  int value_;
};

}  // namespace

fs::path partial_path(const fs::path& file) {
  return file.parent_path() / ("." + file.filename().string() + ".partial");
}

void write_durably(const fs::path& file, std::string_view bytes) {
  const fs::path partial = partial_path(file);
  try {
    const Descriptor out(partial, O_WRONLY | O_CREAT | O_TRUNC);
    out.write_all(bytes);
    out.sync();
    if (::rename(partial.c_str(), file.c_str()) != 0) fail(file, "cannot be renamed from its temporary name");
  } catch (const Error&) {
    ::unlink(partial.c_str());
    throw;
  }
  sync_directory(file.parent_path());
}

void sync_directory(const fs::path& directory) {
  const fs::path path = directory.empty() ? fs::path(".") : directory;
  Descriptor(path, O_RDONLY | O_DIRECTORY).sync();
}

DirectoryLock::DirectoryLock(const fs::path& directory)
    : descriptor_(::open(directory.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
  if (descriptor_ < 0) fail(directory, "cannot be opened");
  if (::flock(descriptor_, LOCK_EX | LOCK_NB) == 0) return;
  const bool held = errno == EWOULDBLOCK;
  ::close(descriptor_);
  if (held) throw Error(directory.string() + ": is being written by another process; only one may write at a time");
  throw Error(directory.string() + ": cannot be locked");
}

DirectoryLock::~DirectoryLock() { ::close(descriptor_); }

}  // namespace lumitexel
