// lumitexel-gphoto-worker: libgphoto2 in a process of its own, which the driver may kill when a camera wedges it.
// Started by GphotoProcess only, with its end of a socket as descriptor 3 and a HOME that belongs to it alone.
#include <poll.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <thread>

#include "drivers/error.h"
#include "drivers/gphoto/gphoto_verbs.h"

namespace {

constexpr int kParent = 3;

// Ends this process as soon as the parent's end of the socket is gone, whatever the library is doing. The kernel's
// parent-death signal would not do: it comes when the parent's *thread* ends that started this process.
void end_with_parent() {
  pollfd parent{kParent, POLLRDHUP, 0};
  while (poll(&parent, 1, -1) < 0 && errno == EINTR) {
  }
  std::error_code ignored;
  if (const char* home = std::getenv("HOME")) {
    const std::filesystem::path folder(home);
    if (std::string_view(folder.filename().c_str()).starts_with("lumitexel-gphoto-")) {
      std::filesystem::remove_all(folder, ignored);
    }
  }
  _exit(0);
}

bool read_exactly(void* into, std::size_t size) {
  return size == 0 || recv(kParent, into, size, MSG_WAITALL) == static_cast<ssize_t>(size);
}

bool write_all(const void* data, std::size_t size) {
  const char* next = static_cast<const char*>(data);
  while (size > 0) {
    const ssize_t count = send(kParent, next, size, MSG_NOSIGNAL);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    next += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

bool read_message(lumitexel::WorkerMessage& message) {
  std::uint8_t prefix[lumitexel::kMessagePrefixBytes];
  if (!read_exactly(prefix, sizeof prefix)) return false;
  const lumitexel::MessageLengths lengths = lumitexel::lengths_of(prefix);
  std::string head(lengths.head, '\0');
  message.bytes.resize(lengths.bytes);
  if (!read_exactly(head.data(), head.size()) || !read_exactly(message.bytes.data(), lengths.bytes)) return false;
  lumitexel::decode_head(head, message);
  return true;
}

}  // namespace

int main() {
  signal(SIGPIPE, SIG_IGN);  // a camera that goes away must not end the process
  signal(SIGINT, SIG_IGN);   // Ctrl-C is the parent's to act on
  std::thread(end_with_parent).detach();
  std::unique_ptr<lumitexel::GphotoSession> session;
  try {
    while (true) {
      lumitexel::WorkerMessage request;
      if (!read_message(request)) return 0;
      const lumitexel::WorkerMessage answer = lumitexel::carry_out(request, session);
      const std::string head = lumitexel::encoded_head(answer);
      if (!write_all(head.data(), head.size()) || !write_all(answer.bytes.data(), answer.bytes.size())) return 0;
    }
  } catch (const lumitexel::Error& error) {
    std::fprintf(stderr, "lumitexel-gphoto-worker: %s\n", error.what());
    return 1;
  }
}
