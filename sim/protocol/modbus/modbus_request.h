// Modbus as a controller sees it: requests out of bytes, replies into bytes, over TCP and over a serial line.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "drivers/modbus/register_map.h"

namespace lumitexel {

using Bytes = std::vector<std::uint8_t>;

enum class Framing { Tcp, Rtu };

// A request, its function code first, and what its reply has to repeat.
struct ModbusFrame {
  std::uint16_t transaction = 0;  // TCP only
  std::uint8_t unit = 0;
  Bytes pdu;
};

// The first whole request in `received`, which it is taken from. Over RTU, bytes whose check sum is wrong go
// unanswered: all of `received` is dropped. A TCP header that cannot be right drops everything, too.
std::optional<ModbusFrame> take_frame(Framing framing, Bytes& received);
Bytes framed(Framing framing, const ModbusFrame& request, const Bytes& reply_pdu);

enum class ModbusException : std::uint8_t {
  None = 0, IllegalFunction = 1, IllegalAddress = 2, IllegalValue = 3, Failure = 4, Acknowledge = 5, Busy = 6
};

// What a request asks for. Functions 1 to 6, 15 and 16; others are IllegalFunction.
struct ModbusRequest {
  ModbusException error = ModbusException::None;
  bool writes = false, several = false;  // several: by function 15 or 16
  RegisterTable table = RegisterTable::Holding;
  int address = 0, count = 0;
  std::vector<std::uint16_t> words;  // of a write; coils: 0 or 1
};

inline constexpr std::uint8_t kDiagnosticsFunction = 8;

ModbusRequest parse_request(const Bytes& pdu);
Bytes exception_reply(const Bytes& pdu, ModbusException code);
Bytes write_reply(const Bytes& pdu);
Bytes read_reply(const Bytes& pdu, const std::vector<std::uint16_t>& words);

}  // namespace lumitexel
