#include "rig/console/interrupt.h"

#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <thread>

#include "drivers/clock.h"

namespace lumitexel {

namespace {

constexpr double kLampsOff_s = 1.5;

// Only what a signal handler may do.
void end_with_a_word(int number) {
  constexpr char kWord[] = "\nlumitexel: stopped; its results were not written, or not all of them\n";
  [[maybe_unused]] const auto written = write(STDERR_FILENO, kWord, sizeof kWord - 1);
  std::signal(number, SIG_DFL);
  std::raise(number);
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

void end_on_interrupt() {
  for (const int number : {SIGINT, SIGTERM}) {
    if (std::signal(number, SIG_IGN) != SIG_IGN) std::signal(number, end_with_a_word);  // who ignores it, as a script's background does, goes on to
  }
}

}  // namespace lumitexel
