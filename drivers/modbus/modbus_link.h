// A Modbus controller that stays connected: values in units, repeated until they have come through.
//
//                  no answer, or none that fits            TCP: at once, a late reply dies with its connection
//   ┌───────────┐ ─────────────────────────────▶ ┌─────────┐ ─────────────────────────────▶ ┌──────────────┐
//   │ Connected │ ◀───────────────────────────── │ Suspect │                                │ Reconnecting │ ◀─┐
//   └───────────┘   serial: silent and in step   └─────────┘ ─────────────────────────────▶ └──────────────┘   │ back off,
//      ▲     │                                                 serial: it is gone               │   │   └───────┘
//      │     └────────────────── the connection breaks ─────────────────────────────────────▶   │   │
//      └──────────────────────── connected, in step ────────────────────────────────────────────┘   ▼ give_up_s
//                                                                    the next request tries again ◀ Lost: Disconnected
//
// Requests may be repeated although the controller has carried them out and only its reply was lost: all that is ever
// written are set-points and commands that say what shall be, not what shall change (a target, on, off, stop, home), so
// that doing it twice ends where doing it once does. Nothing that toggles, counts or steps may be mapped to a register.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "drivers/clock.h"
#include "drivers/modbus/modbus_wire.h"
#include "drivers/modbus/request_turns.h"

namespace lumitexel {

enum class LinkState { Connected, Suspect, Reconnecting, Lost };

// Thread-safe.
class ModbusLink {
 public:
  // Connects, as long as it takes up to give_up_s. Throws Disconnected, Cancelled, and OutOfRange for an endpoint that
  // cannot be. The clock must run with the world's time: a controller's answers do, even if a simulated bench behind it
  // runs faster.
  ModbusLink(const ModbusEndpoint& endpoint, std::shared_ptr<Clock> clock, std::stop_token stop = {});

  const ModbusEndpoint& endpoint() const { return endpoint_; }
  LinkState state() const { return state_; }

  // `what` names the value in errors: "turntable position". A value is one request, of one word or two. Both throw
  //   Disconnected  nothing that fits has come back for give_up_s, reconnecting all the while
  //   Protocol      an exception by Modbus: at once if the register does not exist or does not take the value, else
  //                 (busy, acknowledge, failure) only if it still comes after give_up_s; a float that is no number
  //   Timeout       other threads' requests have kept the line busy for give_up_s
  //   Cancelled     between two tries
  // and none takes longer than give_up_s + 8 * response_timeout_s, waiting for other threads not counted.
  double read(const ModbusRegister& where, const std::string& what, std::stop_token stop = {});
  // Throws also OutOfRange, before anything is sent, for NaN and for what the register cannot hold.
  void write(const ModbusRegister& where, double value, const std::string& what, std::stop_token stop = {});

  // For stopping things: goes before all other requests, and gives every write two chances, the second after a
  // reconnection, each ending after timeout_s; a port that is gone is looked for a few times more. True if all were
  // acknowledged at one of them. A write that fails does not keep the others from being sent. Takes at most
  // (writes + again + 32) * timeout_s, 24 of them on serial lines only, and another thread's request that is under way
  // (response_timeout_s; while it falls in step on a serial line it gives way at once).
  // again: what is written at the second chance, if it shall be split otherwise; empty: the same.
  bool write_urgently(const std::vector<ModbusWrite>& writes, double timeout_s,
                      const std::vector<ModbusWrite>& again = {}) noexcept;
  // The same for a reading; empty if it failed.
  std::optional<double> read_urgently(const ModbusRegister& where, double timeout_s) noexcept;

 private:
  using Request = std::function<WireAnswer(ModbusWire&, double timeout_s)>;
  WireAnswer attempt(const Request& request);
  WireAnswer make_ready(double timeout_s, const GiveWay& give_way = {});
  WireAnswer found_again(double timeout_s);
  void settle(const WireAnswer& answer);
  void exchange(const std::string& asked, const Request& request, std::stop_token stop);
  [[noreturn]] void give_up(const std::string& asked, const WireAnswer& answer);
  bool all_written(const std::vector<ModbusWrite>& writes, const WireAnswer& ready, double timeout_s);

  ModbusEndpoint endpoint_;
  std::shared_ptr<Clock> clock_;
  RequestTurns turns_;
  ModbusWire wire_;  // by whoever has the turn
  std::atomic<LinkState> state_ = LinkState::Reconnecting;
};

}  // namespace lumitexel
