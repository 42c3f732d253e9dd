// One connection to a Modbus controller, TCP or serial: single requests, each with a deadline, each tried once. What to
// do about a request that failed is ModbusLink's affair. Not thread-safe.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>

#include "drivers/modbus/modbus_words.h"
#include "drivers/modbus/register_map.h"
#include "drivers/modbus/serial_line_step.h"

namespace lumitexel {

struct WireAnswer {
  enum class Kind {
    Done,
    Refused,    // by an exception that asking again will not change: illegal function, address or value
    Busy,       // by any other exception: the controller is there and may do it later
    OutOfStep,  // no answer in time, or none that fits: one may still be on its way
    Broken      // the connection is no more
  };
  Kind kind = Kind::Done;
  std::string text;  // what came back, in words
  bool done() const { return kind == Kind::Done; }
};

class ModbusWire {
 public:
  // Does not connect. Throws OutOfRange, naming the controller, for an endpoint that libmodbus has no way to reach.
  explicit ModbusWire(const ModbusEndpoint& endpoint);
  ~ModbusWire();

  // Drops what there is and connects anew, within timeout_s. Done or Broken.
  WireAnswer connect(double timeout_s);

  // Serial lines only, where a reply does not say which request it answers and a late one outlives the port's closing:
  // waits until the line has been silent for quiet_s and then has the controller echo a number made up for the
  // purpose (function 8), for what comes after that is not from before it. A controller that has never been seen to
  // know function 8 is taken to be in step after two silences. At most 6 * quiet_s;
  // OutOfStep as soon as give_way says so.
  WireAnswer fall_in_step(double quiet_s, const GiveWay& give_way = {});

  // words.size() adjoining registers, or bits, in one request.
  WireAnswer read(RegisterTable table, int address, std::span<std::uint16_t> words, double timeout_s);
  WireAnswer write(const ModbusWrite& write, double timeout_s);

 private:
  struct Context;
  WireAnswer finish(int result, std::size_t expected, double timeout_s);

  std::unique_ptr<Context> context_;
  int unit_id_;
  bool serial_;
  bool echoes_ = false;  // knows function 8
  std::uint16_t nonce_ = 0;
};

}  // namespace lumitexel
