// Ctrl-C: as a stop token for commands that end cleanly by themselves when asked, and with a word for the others.
#pragma once

#include <stop_token>
#include <thread>

namespace lumitexel {

// From now on the first SIGINT, SIGTERM, SIGHUP or SIGQUIT requests a stop, from a thread of its own; a second one ends the
// program after a second and a half, in which lamps go off. Output that nobody reads any more ends nothing. Call
// before any other thread starts. Without this call both signals end the program as usual.
std::stop_token stop_on_interrupt();

// SIGINT and SIGTERM end the program as usual, after a line on stderr that says so.
void end_on_interrupt();

// After end_on_interrupt: while one lives, the first of these signals requests a stop instead, after a line on stderr; the next one ends the program.
// For work of which the part that is done is worth writing. Signals that are ignored stay so. One at a time.
class StopOnInterrupt {
 public:
  StopOnInterrupt();  // throws Error where the system gives no pipe
  ~StopOnInterrupt();
  StopOnInterrupt(const StopOnInterrupt&) = delete;
  StopOnInterrupt& operator=(const StopOnInterrupt&) = delete;
  std::stop_token token() const { return source_.get_token(); }

 private:
  std::stop_source source_;
  int wake_[2];           // a pipe: what a signal's handler may do is write into it
  std::jthread waiting_;  // for a byte in it, or its end
};

}  // namespace lumitexel
