// An axis behind a Modbus controller; which register means what is data.
#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "drivers/modbus/modbus_link.h"
#include "drivers/modbus/register_map.h"
#include "drivers/motion.h"

namespace lumitexel {

class ModbusAxis final : public Axis {
 public:
  // limits.tolerance is taken from the map. Sends nothing; call home() before the first motion.
  ModbusAxis(std::string name, std::shared_ptr<ModbusLink> link, ModbusAxisMap map, const AxisLimits& limits,
             std::shared_ptr<Clock> clock);

  std::string name() const override { return name_; }
  AxisLimits limits() const override { return limits_; }

  // Has the axis find its reference if its `homed` register says that it has none, and waits for that; a map without
  // such a register says that it always has one. Throws Timeout after home_timeout_s, Protocol for a fault that the
  // device reports or where there is no command to home it, Disconnected, Cancelled; the axis has then been halted.
  void home(std::stop_token stop);

  // Writes the stop command; without one, sends the axis to where it is now. 50 ms a try, see
  // ModbusLink::write_urgently.
  void halt() noexcept override;

 protected:
  // Throws Protocol for an axis that has lost its reference since: it would go to a wrong place.
  void start(double target, std::stop_token stop) override;
  AxisReading read() const override;

 private:
  bool is_homed(std::stop_token stop) const;
  void wait_until_homed(std::stop_token stop) const;
  std::string fault_text(std::stop_token stop) const;  // empty if there is none
  void give(const ModbusCommand& command, const std::string& what, std::stop_token stop);

  std::string name_;
  std::shared_ptr<ModbusLink> link_;
  ModbusAxisMap map_;
  AxisLimits limits_;
};

}  // namespace lumitexel
