// Getting back in step on a serial line, by bytes: see ModbusWire::fall_in_step.
#pragma once

#include <cstdint>
#include <functional>

namespace lumitexel {

// Asked every few milliseconds; true: somebody has something urgent to say, stop here. May be empty.
using GiveWay = std::function<bool()>;

enum class LineQuiet { Silent, Babbling, Gone };
// Reads and drops until nothing has come for quiet_s, or longest_s is over and something still comes: Babbling, as after
// giving way.
LineQuiet drain(int line_fd, double quiet_s, double longest_s, const GiveWay& give_way);

enum class EchoAnswer { Echoed, Silent, GaveWay, Gone };
// Asks the unit to return `nonce` (function 8, sub-function 0) and waits until it does. An exception in answer to
// function 8 is as good: nothing else is answered so.
EchoAnswer ask_for_echo(int line_fd, int unit_id, std::uint16_t nonce, double timeout_s,
                        const GiveWay& give_way);

}  // namespace lumitexel
