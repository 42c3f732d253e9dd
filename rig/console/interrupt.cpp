#include "rig/console/interrupt.h"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <string>

#include "drivers/clock.h"
#include "drivers/error.h"

namespace lumitexel {

namespace {

constexpr double kLampsOff_s = 1.5;
constexpr int kEnding[] = {SIGINT, SIGTERM};

// Only what a signal handler may do, here and below.
void end_with_a_word(int number) {
  constexpr char kWord[] = "\nlumitexel: stopped; its results were not written, or not all of them\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kWord, sizeof kWord - 1);
  std::signal(number, SIG_DFL);
  std::raise(number);
}

std::atomic<int> wake_into = -1;
static_assert(std::atomic<int>::is_always_lock_free, "a signal's handler reads it");

void ask_to_stop(int number) {
  const int before = errno;
  std::signal(number, end_with_a_word);
  constexpr char kWord[] = "\nlumitexel: stopping once what is under way is done; the same again ends at once and writes nothing\n";
  [[maybe_unused]] auto written = write(STDERR_FILENO, kWord, sizeof kWord - 1);
  written = write(wake_into, "", 1);
  errno = before;
}

// Who ignores a signal, as a script's background does, goes on to.
void handle_unless_ignored(void (*handler)(int)) {
  for (const int number : kEnding) {
    struct sigaction now {};
    sigaction(number, nullptr, &now);
    if (now.sa_handler != SIG_IGN) std::signal(number, handler);
  }
}

}  // namespace

std::stop_token stop_on_interrupt() {
  static std::stop_source source;
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  sigaddset(&signals, SIGHUP);   // the terminal or the connection to it is gone
  sigaddset(&signals, SIGQUIT);
  std::signal(SIGPIPE, SIG_IGN);  // nobody reads our progress any more: no reason to leave a lamp on
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // inherited by every thread that starts later
  // Detached: it waits for a signal for as long as the program lives.
  std::thread([signals] {
    int number = 0;
    sigwait(&signals, &number);
    source.request_stop();
    sigwait(&signals, &number);
    // What is committed is safe. The lamps may not be off yet: they get as long as a controller needs to say so.
    SystemClock clock;
    clock.sleep_until(clock.now_s() + kLampsOff_s, {});
    std::_Exit(128 + number);
  }).detach();
  return source.get_token();
}

void end_on_interrupt() { handle_unless_ignored(end_with_a_word); }

StopOnInterrupt::StopOnInterrupt() {
  if (pipe2(wake_, O_CLOEXEC) != 0) throw Error(std::string("no pipe for Ctrl-C: ") + std::strerror(errno));
  waiting_ = std::jthread([this] {
    char byte = 0;
    if (read(wake_[0], &byte, 1) == 1) source_.request_stop();
  });
  wake_into = wake_[1];
  handle_unless_ignored(ask_to_stop);
}

StopOnInterrupt::~StopOnInterrupt() {
  handle_unless_ignored(end_with_a_word);
  wake_into = -1;
  close(wake_[1]);  // the pipe's end, if no byte came
  waiting_.join();
  close(wake_[0]);
}

}  // namespace lumitexel
