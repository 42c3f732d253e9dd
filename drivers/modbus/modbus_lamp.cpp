#include "drivers/modbus/modbus_lamp.h"

#include <sstream>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr double kUrgent_s = 0.05;

}  // namespace

ModbusLamp::ModbusLamp(std::string name, std::shared_ptr<ModbusLink> link, ModbusLampMap map,
                       std::shared_ptr<Clock> clock)
    : Lamp(std::move(clock), map.settle_s), name_(std::move(name)), link_(std::move(link)), map_(std::move(map)) {}

bool ModbusLamp::is_on() const {
  if (map_.fault) {
    if (const double fault = link_->read(*map_.fault, name_ + " fault"); fault != 0.0) {
      std::ostringstream text;
      text << name_ << ": its controller " << link_->endpoint().name << " reports fault " << fault << " ("
           << to_string(*map_.fault) << "); see the controller's manual";
      throw Protocol(text.str());
    }
  }
  if (map_.lit) return link_->read(*map_.lit, name_ + " lit") != 0.0;
  return link_->read(map_.output, name_ + " output") != 0.0;
}

void ModbusLamp::command(bool on, std::stop_token stop) {
  link_->write(map_.output, on ? 1.0 : 0.0, name_ + " output", stop);
}

void ModbusLamp::force_off() noexcept {
  try {
    link_->write_urgently({write_of({map_.output, 0.0}, link_->endpoint().word_order, name_ + " output")}, kUrgent_s);
  } catch (...) {
    // Nobody could do more about it here; the safety channel has a connection of its own.
  }
}

}  // namespace lumitexel
