// A lamp behind a Modbus controller.
#pragma once

#include <memory>
#include <stop_token>
#include <string>

#include "drivers/light.h"
#include "drivers/modbus/modbus_link.h"
#include "drivers/modbus/register_map.h"

namespace lumitexel {

class ModbusLamp final : public Lamp {
 public:
  // Sends nothing.
  ModbusLamp(std::string name, std::shared_ptr<ModbusLink> link, ModbusLampMap map, std::shared_ptr<Clock> clock);

  std::string name() const override { return name_; }
  // The lamp's own feedback if the map has it, else the output as read back.
  bool is_on() const override;
  // 50 ms a try, see ModbusLink::write_urgently.
  void force_off() noexcept override;

 protected:
  void command(bool on, std::stop_token stop) override;

 private:
  std::string name_;
  std::shared_ptr<ModbusLink> link_;
  ModbusLampMap map_;
};

}  // namespace lumitexel
