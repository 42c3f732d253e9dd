#include "sim/protocol/modbus/modbus_request.h"

#include <algorithm>

namespace lumitexel {
namespace {

constexpr std::size_t kTcpHeader = 7;  // transaction, protocol, length, unit
constexpr std::size_t kLongestPdu = 253;

std::uint16_t word_at(const Bytes& bytes, std::size_t at) {
  return static_cast<std::uint16_t>(bytes[at] << 8 | bytes[at + 1]);
}

void append_word(Bytes& bytes, unsigned word) {
  bytes.push_back(static_cast<std::uint8_t>(word >> 8 & 0xff));
  bytes.push_back(static_cast<std::uint8_t>(word & 0xff));
}

// CRC-16/MODBUS by long division, written apart from the driver's so that the two check each other.
std::uint16_t line_check(const Bytes& bytes, std::size_t count) {
  unsigned remainder = 0xffff;
  for (std::size_t i = 0; i < count; ++i) {
    for (unsigned bit = 0; bit < 8; ++bit) {
      const unsigned carry = (remainder ^ (unsigned{bytes[i]} >> bit)) & 1u;
      remainder = remainder >> 1 ^ (carry != 0 ? 0xa001u : 0u);
    }
  }
  return static_cast<std::uint16_t>(remainder);
}

// How long a request on a serial line is, by its first bytes; 0: not known yet.
std::size_t rtu_length(const Bytes& received) {
  if (received.size() < 8) return 0;
  const bool counted = received[1] == 15 || received[1] == 16;
  return counted ? std::size_t{9} + received[6] : std::size_t{8};
}

std::optional<ModbusFrame> take_rtu(Bytes& received) {
  const std::size_t length = rtu_length(received);
  if (length == 0 || received.size() < length) return std::nullopt;
  const unsigned check = line_check(received, length - 2);
  const bool whole = received[length - 2] == (check & 0xff) && received[length - 1] == check >> 8;
  if (!whole) {
    received.clear();
    return std::nullopt;
  }
  ModbusFrame frame;
  frame.unit = received[0];
  frame.pdu.assign(received.begin() + 1, received.begin() + static_cast<std::ptrdiff_t>(length) - 2);
  received.erase(received.begin(), received.begin() + static_cast<std::ptrdiff_t>(length));
  return frame;
}

std::optional<ModbusFrame> take_tcp(Bytes& received) {
  if (received.size() < kTcpHeader) return std::nullopt;
  const std::size_t length = word_at(received, 4);  // from the unit on
  if (word_at(received, 2) != 0 || length < 2 || length > kLongestPdu + 1) {
    received.clear();
    return std::nullopt;
  }
  if (received.size() < 6 + length) return std::nullopt;
  ModbusFrame frame;
  frame.transaction = word_at(received, 0);
  frame.unit = received[6];
  const auto end = received.begin() + static_cast<std::ptrdiff_t>(6 + length);
  frame.pdu.assign(received.begin() + kTcpHeader, end);
  received.erase(received.begin(), end);
  return frame;
}

// The values of functions 15 and 16, which follow function, address, count and a count of bytes.
void parse_several(const Bytes& pdu, ModbusRequest& request) {
  constexpr std::size_t kValues = 6;
  const bool bits = request.table == RegisterTable::Coil;
  const auto count = static_cast<std::size_t>(request.count);
  const std::size_t bytes = bits ? (count + 7) / 8 : 2 * count;
  if (pdu.size() != kValues + bytes || pdu[5] != bytes) {
    request.error = ModbusException::IllegalValue;
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    request.words.push_back(bits ? static_cast<std::uint16_t>(pdu[kValues + i / 8] >> (i % 8) & 1)
                                 : word_at(pdu, kValues + 2 * i));
  }
}

void parse_single(const Bytes& pdu, ModbusRequest& request) {
  const std::uint16_t value = word_at(pdu, 3);
  request.count = 1;
  if (request.table == RegisterTable::Holding) request.words = {value};
  else if (value == 0x0000 || value == 0xff00) request.words = {static_cast<std::uint16_t>(value != 0 ? 1 : 0)};
  else request.error = ModbusException::IllegalValue;
}

}  // namespace

std::optional<ModbusFrame> take_frame(Framing framing, Bytes& received) {
  return framing == Framing::Tcp ? take_tcp(received) : take_rtu(received);
}

Bytes framed(Framing framing, const ModbusFrame& request, const Bytes& reply_pdu) {
  Bytes bytes;
  if (framing == Framing::Tcp) {
    append_word(bytes, request.transaction);
    append_word(bytes, 0);
    append_word(bytes, static_cast<unsigned>(reply_pdu.size() + 1));
  }
  bytes.push_back(request.unit);
  bytes.insert(bytes.end(), reply_pdu.begin(), reply_pdu.end());
  if (framing == Framing::Rtu) {
    const unsigned check = line_check(bytes, bytes.size());
    append_word(bytes, (check & 0xff) << 8 | check >> 8);  // low byte first
  }
  return bytes;
}

ModbusRequest parse_request(const Bytes& pdu) {
  ModbusRequest request;
  const int function = pdu.empty() ? 0 : pdu[0];
  switch (function) {
    case 1: case 5: case 15: request.table = RegisterTable::Coil; break;
    case 2: request.table = RegisterTable::DiscreteInput; break;
    case 3: case 6: case 16: request.table = RegisterTable::Holding; break;
    case 4: request.table = RegisterTable::Input; break;
    default: request.error = ModbusException::IllegalFunction; return request;
  }
  request.writes = function >= 5;
  request.several = function >= 15;
  if (pdu.size() < 5) {
    request.error = ModbusException::IllegalValue;
    return request;
  }
  request.address = word_at(pdu, 1);
  request.count = word_at(pdu, 3);
  if (request.several) parse_several(pdu, request);
  else if (request.writes) parse_single(pdu, request);
  const int most = request.table == RegisterTable::Coil || request.table == RegisterTable::DiscreteInput ? 2000 : 125;
  if (request.count < 1 || request.count > most) request.error = ModbusException::IllegalValue;
  return request;
}

Bytes exception_reply(const Bytes& pdu, ModbusException code) {
  return {static_cast<std::uint8_t>((pdu.empty() ? 0 : pdu[0]) | 0x80), static_cast<std::uint8_t>(code)};
}

Bytes write_reply(const Bytes& pdu) { return Bytes(pdu.begin(), pdu.begin() + 5); }

Bytes read_reply(const Bytes& pdu, const std::vector<std::uint16_t>& words) {
  const bool bits = pdu[0] <= 2;
  Bytes reply{pdu[0], static_cast<std::uint8_t>(bits ? (words.size() + 7) / 8 : 2 * words.size())};
  if (!bits) {
    for (const std::uint16_t word : words) append_word(reply, word);
    return reply;
  }
  reply.resize(2 + (words.size() + 7) / 8, 0);
  for (std::size_t i = 0; i < words.size(); ++i) {
    if (words[i] != 0) reply[2 + i / 8] = static_cast<std::uint8_t>(reply[2 + i / 8] | 1u << (i % 8));
  }
  return reply;
}

}  // namespace lumitexel
