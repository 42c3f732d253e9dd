#include "rig/console/interrupt.h"

#include <csignal>
#include <cstdlib>
#include <thread>

namespace lumitexel {

std::stop_token stop_on_interrupt() {
  static std::stop_source source;
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);  // inherited by every thread that starts later
  // Detached: it waits for a signal for as long as the program lives.
  std::thread([signals] {
    int number = 0;
    sigwait(&signals, &number);
    source.request_stop();
    sigwait(&signals, &number);
    std::_Exit(128 + number);  // what is committed is safe; the rest is what the user wants gone
  }).detach();
  return source.get_token();
}

}  // namespace lumitexel
