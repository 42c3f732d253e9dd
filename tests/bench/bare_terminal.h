// A pseudo-terminal and an echo at its other end, nothing else: what the kernel alone takes for a serial round trip. Its
// bytes go through a worker thread of the kernel's, which on a loaded machine may wait for its turn.
#pragma once

#include <thread>

namespace lumitexel {

class BareTerminal {
 public:
  BareTerminal();  // throws Error if there is none to be had
  ~BareTerminal();
  BareTerminal(const BareTerminal&) = delete;
  BareTerminal& operator=(const BareTerminal&) = delete;

  // Milliseconds for eight bytes there and back; infinity: not within two seconds.
  double round_trip_ms();

 private:
  int master_ = -1, slave_ = -1;
  std::jthread echo_;
};

}  // namespace lumitexel
