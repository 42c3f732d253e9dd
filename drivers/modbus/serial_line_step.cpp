#include "drivers/modbus/serial_line_step.h"

#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <span>
#include <vector>

namespace lumitexel {
namespace {

constexpr std::uint8_t kDiagnostics = 0x08;

// The serial line's check sum: CRC-16 with polynomial 0x8005, bits reversed, sent low byte first.
std::uint16_t crc16(std::span<const std::uint8_t> bytes) {
  std::uint16_t crc = 0xffff;
  for (const std::uint8_t byte : bytes) {
    crc = static_cast<std::uint16_t>(crc ^ byte);
    for (int bit = 0; bit < 8; ++bit) crc = static_cast<std::uint16_t>((crc & 1) != 0 ? (crc >> 1) ^ 0xa001 : crc >> 1);
  }
  return crc;
}

std::vector<std::uint8_t> checked(std::vector<std::uint8_t> bytes) {
  const std::uint16_t crc = crc16(bytes);
  bytes.push_back(static_cast<std::uint8_t>(crc & 0xff));
  bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
  return bytes;
}

bool ends_with(const std::vector<std::uint8_t>& bytes, const std::vector<std::uint8_t>& end) {
  return bytes.size() >= end.size() && std::equal(end.rbegin(), end.rend(), bytes.rbegin());
}

// How many bytes came within timeout_s: 0 for none, -1 for a line that is gone.
int receive(int fd, std::span<std::uint8_t> into, int timeout_ms) {
  pollfd waiting{fd, POLLIN, 0};
  const int ready = poll(&waiting, 1, timeout_ms);
  if (ready <= 0) return ready < 0 && errno != EINTR ? -1 : 0;
  const ssize_t got = read(fd, into.data(), into.size());
  if (got > 0) return static_cast<int>(got);
  return got < 0 && (errno == EAGAIN || errno == EINTR) ? 0 : -1;
}

int milliseconds(double time_s) { return std::max(1, static_cast<int>(std::ceil(time_s * 1e3))); }

}  // namespace

// The time that passed is counted in waits of at most kSlice_ms: generous where bytes keep coming, never endless.
LineQuiet drain(int line_fd, double quiet_s, double longest_s, const GiveWay& give_way) {
  constexpr int kSlice_ms = 5;
  std::array<std::uint8_t, 256> dropped{};
  int quiet_ms = 0;
  for (int waited_ms = 0; waited_ms < milliseconds(longest_s); waited_ms += kSlice_ms) {
    if (give_way && give_way()) break;
    const int got = receive(line_fd, dropped, kSlice_ms);
    if (got < 0) return LineQuiet::Gone;
    quiet_ms = got > 0 ? 0 : quiet_ms + kSlice_ms;
    if (quiet_ms >= milliseconds(quiet_s)) return LineQuiet::Silent;
  }
  return LineQuiet::Babbling;
}

EchoAnswer ask_for_echo(int line_fd, int unit_id, std::uint16_t nonce, double timeout_s, const GiveWay& give_way) {
  const auto unit = static_cast<std::uint8_t>(unit_id);
  const auto high = static_cast<std::uint8_t>(nonce >> 8), low = static_cast<std::uint8_t>(nonce & 0xff);
  const std::vector<std::uint8_t> request = checked({unit, kDiagnostics, 0, 0, high, low});
  const std::vector<std::uint8_t> refusal = checked({unit, kDiagnostics | 0x80, 1});
  if (::write(line_fd, request.data(), request.size()) != static_cast<ssize_t>(request.size())) return EchoAnswer::Gone;
  std::vector<std::uint8_t> answer;
  std::array<std::uint8_t, 64> part{};
  // Late replies may come before the echo; they are not looked at.
  constexpr int kSlice_ms = 5;
  for (int waited_ms = 0; waited_ms < milliseconds(timeout_s); waited_ms += kSlice_ms) {
    if (give_way && give_way()) return EchoAnswer::GaveWay;
    const int got = receive(line_fd, part, kSlice_ms);
    if (got < 0) return EchoAnswer::Gone;
    answer.insert(answer.end(), part.begin(), part.begin() + got);
    if (ends_with(answer, request) || ends_with(answer, refusal)) return EchoAnswer::Echoed;
  }
  return EchoAnswer::Silent;
}

}  // namespace lumitexel
