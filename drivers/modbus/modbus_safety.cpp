#include "drivers/modbus/modbus_safety.h"

#include <algorithm>

namespace lumitexel {
namespace {

constexpr double kUrgent_s = 0.05;

}  // namespace

ModbusSafety::ModbusSafety(std::shared_ptr<ModbusLink> link, const std::vector<ModbusLampMap>& lamps,
                           const std::vector<ModbusAxisMap>& axes)
    : link_(std::move(link)) {
  const ModbusEndpoint& endpoint = link_->endpoint();
  const std::string what = "controller " + endpoint.name + ": made safe";
  const auto prepared = [&](const ModbusCommand& command) { return write_of(command, endpoint.word_order, what); };
  for (const ModbusLampMap& lamp : lamps) {
    if (lamp.controller != endpoint.name) continue;
    one_by_one_.push_back(prepared({lamp.output, 0.0}));
    any_register_ = lamp.output;
  }
  for (const ModbusAxisMap& axis : axes) {
    if (axis.controller != endpoint.name) continue;
    if (axis.stop) one_by_one_.push_back(prepared(*axis.stop));
    any_register_ = axis.position;
  }
  together_ = joined(one_by_one_);
  if (endpoint.watchdog) watchdog_.push_back(prepared(*endpoint.watchdog));
}

bool ModbusSafety::make_safe() noexcept { return link_->write_urgently(together_, kUrgent_s, one_by_one_); }

bool ModbusSafety::kick_watchdog() noexcept {
  const double timeout_s = std::min(link_->endpoint().response_timeout_s, link_->endpoint().watchdog_period_s / 4.0);
  if (!watchdog_.empty()) return link_->write_urgently(watchdog_, timeout_s);
  return any_register_ && link_->read_urgently(*any_register_, timeout_s).has_value();
}

std::shared_ptr<ModbusLink> connect_for_safety(const std::shared_ptr<ModbusLink>& devices, std::shared_ptr<Clock> clock,
                                               std::stop_token stop) {
  if (devices->endpoint().host.empty()) return devices;
  return std::make_shared<ModbusLink>(devices->endpoint(), std::move(clock), stop);
}

}  // namespace lumitexel
