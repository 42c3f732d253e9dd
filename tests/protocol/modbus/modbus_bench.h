// A small bench behind a simulated Modbus controller, and the drivers connected to it.
#pragma once

#include <memory>
#include <string>

#include "armed_faults.h"
#include "drivers/modbus/modbus_axis.h"
#include "drivers/modbus/modbus_lamp.h"
#include "drivers/modbus/modbus_link.h"
#include "drivers/modbus/modbus_safety.h"
#include "sim/protocol/modbus/modbus_controller_server.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {

enum class Transport { Tcp, Rtu };
const char* to_string(Transport transport);

inline constexpr double kBenchHaste = 50.0;  // bench seconds in a second

// Every way that a register map can be: three types of position, a start register or none, coils and a control word.
struct ModbusMaps {
  ModbusAxisMap turntable, light_azimuth, light_elevation;
  ModbusLampMap point_light, ring_flash, backlight;
};
ModbusMaps mixed_maps();

// Short times, so that faults cost little: 0.02 s to a timeout, late replies after 0.035 s.
ModbusServerSettings quick_settings(Transport transport);

// The members may be replaced by a test: the server by a restarted one, for instance.
struct ModbusBench {
  explicit ModbusBench(Transport transport) : ModbusBench(quick_settings(transport)) {}
  explicit ModbusBench(const ModbusServerSettings& settings, double haste = kBenchHaste);

  std::shared_ptr<ModbusLink> new_link() const;
  // limits: the bench's, but patient with faults that hold up the reading.
  std::unique_ptr<ModbusAxis> axis(BenchAxis which) const;
  std::unique_ptr<ModbusLamp> lamp(BenchLamp which) const;
  std::unique_ptr<ModbusSafety> safety() const;
  void restart_server();  // at the same address

  TemporaryFolder folder;  // of the serial port's name, which outlives a restart
  std::shared_ptr<Clock> real_clock, bench_clock;
  std::shared_ptr<SimulatedBench> bench;
  std::shared_ptr<ArmedFaults> faults = std::make_shared<ArmedFaults>();
  ModbusServerSettings settings;
  std::unique_ptr<ModbusControllerServer> server;
  std::shared_ptr<ModbusLink> link;
};

// What the action threw, of any type; fails the test if nothing.
std::string message_of(const std::function<void()>& action);

// Seconds that it took.
double seconds_of(const std::function<void()>& action);

}  // namespace lumitexel
