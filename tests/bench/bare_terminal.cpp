#include "tests/bench/bare_terminal.h"

#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <limits>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr int kPatience_ms = 2000;

void echo_until(std::stop_token stop, int fd) {
  std::array<char, 64> bytes{};
  while (!stop.stop_requested()) {
    pollfd waiting{fd, POLLIN, 0};
    if (poll(&waiting, 1, 20) <= 0) continue;
    const ssize_t got = read(fd, bytes.data(), bytes.size());
    if (got > 0 && write(fd, bytes.data(), static_cast<std::size_t>(got)) != got) return;
  }
}

}  // namespace

BareTerminal::BareTerminal() {
  termios raw{};
  cfmakeraw(&raw);
  if (openpty(&master_, &slave_, nullptr, &raw, nullptr) != 0) throw Error("bare terminal: no pseudo-terminal");
  echo_ = std::jthread(echo_until, master_);
}

BareTerminal::~BareTerminal() {
  echo_.request_stop();
  if (echo_.joinable()) echo_.join();
  close(slave_);
  close(master_);
}

double BareTerminal::round_trip_ms() {
  const auto start = std::chrono::steady_clock::now();
  std::array<char, 8> bytes{};
  if (write(slave_, bytes.data(), bytes.size()) != static_cast<ssize_t>(bytes.size())) throw Error("bare terminal: full");
  for (std::size_t missing = bytes.size(); missing > 0;) {
    pollfd waiting{slave_, POLLIN, 0};
    if (poll(&waiting, 1, kPatience_ms) <= 0) return std::numeric_limits<double>::infinity();
    const ssize_t got = read(slave_, bytes.data(), missing);
    if (got > 0) missing -= static_cast<std::size_t>(got);
  }
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace lumitexel
