#include "drivers/gphoto/gphoto_process.h"

#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <stdlib.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr int kWorkerEnd = 3;      // the descriptor that the worker expects
constexpr int kSlice_ms = 20;      // how long a stop request may go unnoticed
constexpr double kLastWait_s = 2;  // for a killed process to be gone

// This process's environment with another HOME: libgphoto2 writes its settings there.
std::vector<std::string> environment_with_home(const std::filesystem::path& home) {
  std::vector<std::string> variables{"HOME=" + home.string()};
  for (char** entry = environ; *entry != nullptr; ++entry) {
    if (std::strncmp(*entry, "HOME=", 5) != 0) variables.emplace_back(*entry);
  }
  return variables;
}

std::vector<char*> pointers_to(std::vector<std::string>& texts) {
  std::vector<char*> pointers;
  for (std::string& text : texts) pointers.push_back(text.data());
  pointers.push_back(nullptr);
  return pointers;
}

// The worker gets its end of the socket and the standard descriptors, and none of the program's others. Returns 0 or
// errno.
int spawn(const std::string& worker, int socket, std::vector<std::string> environment, pid_t& pid) {
  std::vector<std::string> words{worker};
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, socket, kWorkerEnd);  // stays open on exec, even if it is 3 already
  posix_spawn_file_actions_addclosefrom_np(&actions, kWorkerEnd + 1);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  sigset_t none;
  sigemptyset(&none);
  posix_spawnattr_setsigmask(&attributes, &none);  // whatever this thread blocks
  posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
  const int failed = posix_spawn(&pid, worker.c_str(), &actions, &attributes, pointers_to(words).data(),
                                 pointers_to(environment).data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  return failed;
}

std::filesystem::path private_home() {
  std::string pattern = (std::filesystem::temp_directory_path() / "lumitexel-gphoto-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) throw StorageFull(pattern + ": cannot be made: " + std::strerror(errno));
  return pattern;
}

}  // namespace

std::filesystem::path default_gphoto_worker() {
  if (const char* named = std::getenv("LUMITEXEL_GPHOTO_WORKER"); named != nullptr && *named != '\0') return named;
  return std::filesystem::read_symlink("/proc/self/exe").parent_path() / "lumitexel-gphoto-worker";
}

GphotoProcess::GphotoProcess(std::string name, std::filesystem::path worker, std::shared_ptr<Clock> clock)
    : name_(std::move(name)), worker_(std::move(worker)), clock_(std::move(clock)) {}

GphotoProcess::~GphotoProcess() { kill(); }

void GphotoProcess::start() {
  kill();
  if (access(worker_.c_str(), X_OK) != 0) {
    throw BadInput(name_, "no program at " + worker_.string(),
                   "lumitexel-gphoto-worker beside this program, or its path in LUMITEXEL_GPHOTO_WORKER");
  }
  home_ = private_home();
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
    throw Disconnected(name_ + ": no socket for its worker: " + std::strerror(errno));
  }
  socket_ = ends[0];
  const int failed = spawn(worker_.string(), ends[1], environment_with_home(home_), pid_);
  close(ends[1]);
  if (failed != 0) {
    pid_ = 0;
    kill();
    throw Disconnected(name_ + ": its worker " + worker_.string() + " did not start: " + std::strerror(failed));
  }
}

void GphotoProcess::kill() noexcept {
  if (socket_ >= 0) close(std::exchange(socket_, -1));
  if (pid_ > 0) {
    ::kill(pid_, SIGKILL);
    const double deadline_s = clock_->now_s() + kLastWait_s;
    while (waitpid(pid_, nullptr, WNOHANG) == 0 && clock_->now_s() < deadline_s) poll(nullptr, 0, 1);
    pid_ = 0;
  }
  std::error_code ignored;
  if (!home_.empty()) std::filesystem::remove_all(std::exchange(home_, {}), ignored);
}

WorkerMessage GphotoProcess::exchange(const WorkerMessage& request, double timeout_s, std::stop_token stop) {
  const Wait wait{request.field("verb"), timeout_s, clock_->now_s() + timeout_s, stop};
  if (!is_running()) throw Disconnected(name_ + ": " + wait.verb + ": its worker is not running");
  WorkerMessage answer;
  try {
    answer = exchanged(request, wait);
  } catch (const Error&) {
    kill();
    throw;
  }
  throw_failure(answer, wait.verb);
  return answer;
}

WorkerMessage GphotoProcess::exchanged(const WorkerMessage& request, const Wait& wait) {
  const std::string head = encoded_head(request);
  send(std::span(reinterpret_cast<const std::uint8_t*>(head.data()), head.size()), wait);
  send(request.bytes, wait);
  std::uint8_t prefix[kMessagePrefixBytes];
  receive(prefix, wait);
  const MessageLengths lengths = lengths_of(prefix);
  std::string answer_head(lengths.head, '\0');
  receive(std::span(reinterpret_cast<std::uint8_t*>(answer_head.data()), answer_head.size()), wait);
  WorkerMessage answer;
  decode_head(answer_head, answer);
  answer.bytes.resize(lengths.bytes);
  receive(answer.bytes, wait);
  return answer;
}

void GphotoProcess::wait_for(short what, const Wait& wait) const {
  while (true) {
    if (wait.stop.stop_requested()) throw Cancelled(name_ + ": " + wait.verb + " cancelled");
    pollfd entry{socket_, what, 0};
    if (poll(&entry, 1, kSlice_ms) > 0) return;
    if (clock_->now_s() < wait.deadline_s) continue;
    throw Timeout(name_ + ": " + wait.verb + ": no answer within " + std::to_string(wait.timeout_s) +
                  " s; the worker is restarted");
  }
}

void GphotoProcess::send(std::span<const std::uint8_t> data, const Wait& wait) const {
  while (!data.empty()) {
    wait_for(POLLOUT, wait);
    const ssize_t count = ::send(socket_, data.data(), data.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count >= 0) {
      data = data.subspan(static_cast<std::size_t>(count));
    } else if (errno != EAGAIN && errno != EINTR) {
      fail_ended(wait);
    }
  }
}

void GphotoProcess::receive(std::span<std::uint8_t> into, const Wait& wait) const {
  while (!into.empty()) {
    wait_for(POLLIN, wait);
    const ssize_t count = recv(socket_, into.data(), into.size(), MSG_DONTWAIT);
    if (count > 0) {
      into = into.subspan(static_cast<std::size_t>(count));
    } else if (count == 0 || (errno != EAGAIN && errno != EINTR)) {
      fail_ended(wait);
    }
  }
}

void GphotoProcess::fail_ended(const Wait& wait) const {
  throw Disconnected(name_ + ": " + wait.verb + ": its worker ended by itself; it is restarted");
}

void GphotoProcess::throw_failure(const WorkerMessage& answer, const std::string& verb) const {
  if (!answer.fields.contains("cause")) return;
  const std::string& cause = answer.field("cause");
  const std::string text = name_ + ": " + verb + ": " + answer.field("text");
  if (cause == "timeout") throw Timeout(text);
  if (cause == "disconnected") throw Disconnected(text);
  if (cause == "out_of_range") throw OutOfRange(text);
  if (cause == "storage_full") throw StorageFull(text);
  throw Protocol(text);
}

}  // namespace lumitexel
