#include "drivers/modbus/modbus_axis.h"

#include <sstream>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr double kPoll_s = 0.05;
constexpr double kUrgent_s = 0.05;

}  // namespace

ModbusAxis::ModbusAxis(std::string name, std::shared_ptr<ModbusLink> link, ModbusAxisMap map, const AxisLimits& limits,
                       std::shared_ptr<Clock> clock)
    : Axis(std::move(clock)), name_(std::move(name)), link_(std::move(link)), map_(std::move(map)), limits_(limits) {
  limits_.tolerance = map_.tolerance;
}

void ModbusAxis::home(std::stop_token stop) {
  if (is_homed(stop)) return;
  if (!map_.home) {
    throw Protocol(name_ + ": has no reference, and no command to find it is described; home it at its controller");
  }
  try {
    give(*map_.home, "home", stop);
    wait_until_homed(stop);
  } catch (const Error&) {
    halt();
    throw;
  }
}

void ModbusAxis::wait_until_homed(std::stop_token stop) const {
  const double deadline_s = clock().now_s() + map_.home_timeout_s;
  for (;;) {
    if (const std::string fault = fault_text(stop); !fault.empty()) throw Protocol(name_ + ": " + fault);
    // Homed first: an axis that stands still after it had its reference has finished.
    if (is_homed(stop) && !(map_.moving && link_->read(*map_.moving, name_ + " moving", stop) != 0.0)) return;
    if (clock().now_s() > deadline_s) {
      std::ostringstream text;
      text << name_ << ": told to home, has not found its reference after " << map_.home_timeout_s
           << " s; look for what blocks it or its reference switch";
      throw Timeout(text.str());
    }
    clock().sleep_until(clock().now_s() + kPoll_s, stop);
  }
}

bool ModbusAxis::is_homed(std::stop_token stop) const {
  return !map_.homed || link_->read(*map_.homed, name_ + " homed", stop) != 0.0;
}

std::string ModbusAxis::fault_text(std::stop_token stop) const {
  if (!map_.fault) return "";
  const double fault = link_->read(*map_.fault, name_ + " fault", stop);
  if (fault == 0.0) return "";
  std::ostringstream text;
  text << "its controller " << link_->endpoint().name << " reports fault " << fault << " (" << to_string(*map_.fault)
       << "); see the controller's manual";
  return text.str();
}

void ModbusAxis::give(const ModbusCommand& command, const std::string& what, std::stop_token stop) {
  link_->write(command.where, command.value, name_ + " " + what, stop);
}

void ModbusAxis::start(double target, std::stop_token stop) {
  if (!is_homed(stop)) throw Protocol(name_ + ": has lost its reference; have it homed before it moves");
  link_->write(map_.target, target, name_ + " target", stop);
  if (map_.start) give(*map_.start, "start", stop);
}

AxisReading ModbusAxis::read() const {
  AxisReading reading;
  // Before the position, so that a position beside "not moving" is one where it had stopped already.
  if (map_.moving) reading.moving = link_->read(*map_.moving, name_ + " moving") != 0.0;
  reading.position = link_->read(map_.position, name_ + " position");
  reading.fault = fault_text({});
  return reading;
}

void ModbusAxis::halt() noexcept {
  try {
    const WordOrder order = link_->endpoint().word_order;
    if (map_.stop) {
      link_->write_urgently({write_of(*map_.stop, order, name_ + " stop")}, kUrgent_s);
      return;
    }
    const std::optional<double> here = link_->read_urgently(map_.position, kUrgent_s);
    if (!here) return;
    std::vector<ModbusWrite> writes{write_of({map_.target, *here}, order, name_ + " target")};
    if (map_.start) writes.push_back(write_of(*map_.start, order, name_ + " start"));
    link_->write_urgently(writes, kUrgent_s);
  } catch (...) {
    // Nobody could do more about it here; the safety channel has a connection of its own.
  }
}

}  // namespace lumitexel
