#include "drivers/modbus/modbus_link.h"

#include <algorithm>
#include <sstream>

#include "drivers/error.h"

namespace lumitexel {
namespace {

using Kind = WireAnswer::Kind;

constexpr double kFirstPause_s = 0.01, kLongestPause_s = 0.2;

double after_pause(double pause_s) { return std::clamp(2.0 * pause_s, kFirstPause_s, kLongestPause_s); }

}  // namespace

ModbusLink::ModbusLink(const ModbusEndpoint& endpoint, std::shared_ptr<Clock> clock, std::stop_token stop)
    : endpoint_(endpoint), clock_(std::move(clock)), wire_(endpoint) {
  exchange("connecting", [](ModbusWire&, double) { return WireAnswer{}; }, stop);
}

double ModbusLink::read(const ModbusRegister& where, const std::string& what, std::stop_token stop) {
  std::vector<std::uint16_t> words(static_cast<std::size_t>(word_count(where)));
  const auto request = [&](ModbusWire& wire, double timeout_s) {
    return wire.read(where.table, where.address, words, timeout_s);
  };
  exchange("reading " + what + " (" + to_string(where) + ")", request, stop);
  return value_from_words(where, words, endpoint_.word_order, "controller " + endpoint_.name + ": " + what);
}

void ModbusLink::write(const ModbusRegister& where, double value, const std::string& what, std::stop_token stop) {
  const ModbusWrite write =
      write_of({where, value}, endpoint_.word_order, "controller " + endpoint_.name + ": " + what);
  std::ostringstream asked;
  asked << "writing " << value << " to " << what << " (" << to_string(where) << ")";
  exchange(asked.str(), [&](ModbusWire& wire, double timeout_s) { return wire.write(write, timeout_s); }, stop);
}

// The turn is given back between two tries, so that something urgent need not wait for the pauses.
void ModbusLink::exchange(const std::string& asked, const Request& request, std::stop_token stop) {
  const double give_up_at_s = clock_->now_s() + endpoint_.give_up_s;
  for (double pause_s = 0.0;; pause_s = after_pause(pause_s)) {
    if (stop.stop_requested()) throw Cancelled("controller " + endpoint_.name + ": " + asked + ": cancelled");
    const WireAnswer answer = attempt(request);
    if (answer.done()) return;
    const bool out_of_time = clock_->now_s() + pause_s >= give_up_at_s;
    if (answer.kind == Kind::Refused || out_of_time) give_up(asked, answer);
    clock_->sleep_until(clock_->now_s() + pause_s, stop);
  }
}

WireAnswer ModbusLink::attempt(const Request& request) {
  const RequestTurns::Turn turn(turns_, false, endpoint_.give_up_s);
  if (!turn.taken()) throw Timeout("controller " + endpoint_.name + ": other requests keep its line busy");
  const double timeout_s = endpoint_.response_timeout_s;
  if (const WireAnswer ready = make_ready(timeout_s, [this] { return turns_.urgent_is_waiting(); }); !ready.done()) {
    return ready;
  }
  const WireAnswer answer = request(wire_, timeout_s);
  settle(answer);
  return answer;
}

WireAnswer ModbusLink::make_ready(double timeout_s, const GiveWay& give_way) {
  if (state_ == LinkState::Connected) return {};
  WireAnswer ready{Kind::Broken, ""};
  const bool serial = endpoint_.host.empty();
  if (state_ == LinkState::Suspect && serial) {
    ready = wire_.fall_in_step(timeout_s, give_way);
  } else if (ready = wire_.connect(timeout_s); ready.done()) {
    ready = wire_.fall_in_step(timeout_s, give_way);
  }
  // Silence where an echo was due leaves the line suspect; a port that is opened again does not make it better.
  state_ = ready.done() ? LinkState::Connected
           : ready.kind == Kind::OutOfStep ? LinkState::Suspect
                                           : LinkState::Reconnecting;
  return ready;
}

void ModbusLink::settle(const WireAnswer& answer) {
  if (answer.kind == Kind::OutOfStep) state_ = LinkState::Suspect;
  if (answer.kind == Kind::Broken) state_ = LinkState::Reconnecting;
}

void ModbusLink::give_up(const std::string& asked, const WireAnswer& answer) {
  const std::string said = "controller " + endpoint_.name + ": " + asked + ": " + answer.text;
  if (answer.kind == Kind::Refused) throw Protocol(said + "; check the register map against the controller's manual");
  std::ostringstream text;
  text << said << "; gave up after " << endpoint_.give_up_s << " s";
  if (answer.kind == Kind::Busy) throw Protocol(text.str() + "; see what the controller itself displays");
  state_ = LinkState::Lost;
  const bool serial = endpoint_.host.empty();
  text << "; check its power and the cable to "
       << (serial ? endpoint_.serial_device : endpoint_.host + ":" + std::to_string(endpoint_.port));
  throw Disconnected(text.str());
}

bool ModbusLink::write_urgently(const std::vector<ModbusWrite>& writes, double timeout_s,
                                const std::vector<ModbusWrite>& again) noexcept {
  try {
    const RequestTurns::Turn turn(turns_, true, endpoint_.give_up_s);
    if (!turn.taken()) return false;
    if (all_written(writes, make_ready(timeout_s), timeout_s)) return true;
    // All of them again, not only those that seem to have failed: on a serial line one write's late acknowledgement
    // looks like the next one's.
    return all_written(again.empty() ? writes : again, found_again(timeout_s), timeout_s);
  } catch (...) {
    return false;
  }
}

// A serial adapter that lost its contact takes some time to appear again.
WireAnswer ModbusLink::found_again(double timeout_s) {
  constexpr int kLooks = 4;
  for (int look = 1;; ++look) {
    const WireAnswer ready = make_ready(timeout_s);
    if (ready.kind != Kind::Broken || look == kLooks) return ready;
    clock_->sleep_until(clock_->now_s() + 0.5 * timeout_s, {});
  }
}

// On a line that is out of step nothing can be believed, but everything can still be said.
bool ModbusLink::all_written(const std::vector<ModbusWrite>& writes, const WireAnswer& ready, double timeout_s) {
  if (ready.kind == Kind::Broken) return false;
  bool all = ready.done();
  for (const ModbusWrite& write : writes) {
    const WireAnswer answer = wire_.write(write, timeout_s);
    settle(answer);
    all = all && answer.done();
  }
  return all;
}

std::optional<double> ModbusLink::read_urgently(const ModbusRegister& where, double timeout_s) noexcept {
  try {
    const RequestTurns::Turn turn(turns_, true, endpoint_.give_up_s);
    if (!turn.taken()) return std::nullopt;
    std::vector<std::uint16_t> words(static_cast<std::size_t>(word_count(where)));
    for (int chance = 0; chance < 2; ++chance) {
      if (!make_ready(timeout_s).done()) continue;
      const WireAnswer answer = wire_.read(where.table, where.address, words, timeout_s);
      settle(answer);
      if (answer.done()) return value_from_words(where, words, endpoint_.word_order, "urgent reading");
    }
  } catch (...) {
  }
  return std::nullopt;
}

}  // namespace lumitexel
