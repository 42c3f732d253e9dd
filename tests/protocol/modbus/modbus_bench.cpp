#include "modbus_bench.h"

#include <gtest/gtest.h>

#include "drivers/error.h"
#include "tests/protocol/hastened_clock.h"
#include "tests/unit/small_rig.h"

namespace lumitexel {
namespace {

ModbusRegister coil(int address) { return {RegisterTable::Coil, address, RegisterType::Bit}; }
ModbusRegister discrete(int address) { return {RegisterTable::DiscreteInput, address, RegisterType::Bit}; }
ModbusRegister input(int address, RegisterType type = RegisterType::Uint16, double counts_per_unit = 1.0) {
  return {RegisterTable::Input, address, type, counts_per_unit};
}
ModbusRegister holding(int address, RegisterType type = RegisterType::Uint16, double counts_per_unit = 1.0) {
  return {RegisterTable::Holding, address, type, counts_per_unit};
}

}  // namespace

const char* to_string(Transport transport) { return transport == Transport::Tcp ? "Tcp" : "Rtu"; }

ModbusMaps mixed_maps() {
  ModbusMaps maps;
  ModbusAxisMap& table = maps.turntable;
  table.position = input(0, RegisterType::Int32, 1000.0);
  table.target = holding(0, RegisterType::Int32, 1000.0);
  table.stop = ModbusCommand{coil(8)};
  table.home = ModbusCommand{coil(11)};
  table.moving = discrete(0);
  table.homed = discrete(8);
  table.fault = input(100);

  ModbusAxisMap& azimuth = maps.light_azimuth;
  azimuth.position = input(2, RegisterType::Float32);
  azimuth.target = holding(2, RegisterType::Float32);
  azimuth.start = ModbusCommand{coil(12)};
  azimuth.stop = ModbusCommand{coil(9)};
  azimuth.fault = input(101);

  ModbusAxisMap& elevation = maps.light_elevation;
  elevation.position = input(4, RegisterType::Int16, 100.0);
  elevation.target = holding(4, RegisterType::Int16, 100.0);
  elevation.start = ModbusCommand{holding(10), 1.0};
  elevation.stop = ModbusCommand{holding(10), 2.0};
  elevation.home = ModbusCommand{holding(10), 4.0};
  elevation.moving = discrete(2);
  elevation.homed = discrete(10);

  maps.point_light.output = coil(5);
  maps.point_light.lit = discrete(16);
  maps.point_light.fault = input(110);
  maps.ring_flash.output = coil(6);
  maps.ring_flash.lit = discrete(17);
  maps.backlight.output = coil(7);
  for (ModbusAxisMap* axis : {&table, &azimuth, &elevation}) axis->controller = "bench";
  for (ModbusLampMap* lamp : {&maps.point_light, &maps.ring_flash, &maps.backlight}) {
    lamp->controller = "bench";
    lamp->settle_s = 0.001;
  }
  return maps;
}

ModbusServerSettings quick_settings(Transport transport) {
  const ModbusMaps maps = mixed_maps();
  ModbusServerSettings settings;
  settings.endpoint.name = "bench";
  if (transport == Transport::Tcp) {
    settings.endpoint.host = "127.0.0.1";
    settings.endpoint.port = 0;
  }
  settings.endpoint.response_timeout_s = 0.02;
  settings.endpoint.give_up_s = 2.0;
  settings.late_by_s = 0.035;
  settings.axes = {{BenchAxis::Turntable, maps.turntable},
                   {BenchAxis::LightAzimuth, maps.light_azimuth},
                   {BenchAxis::LightElevation, maps.light_elevation}};
  settings.lamps = {{BenchLamp::Point, maps.point_light},
                    {BenchLamp::Ring, maps.ring_flash},
                    {BenchLamp::Back, maps.backlight}};
  return settings;
}

ModbusBench::ModbusBench(const ModbusServerSettings& given, double haste)
    : real_clock(std::make_shared<SystemClock>()),
      bench_clock(std::make_shared<HastenedClock>(haste)),
      bench(std::make_shared<SimulatedBench>(
          small_rig(), BenchBehaviour{}, bench_clock,
          [](const WorldState&, const CameraSettings&, std::uint64_t) { return std::vector<std::uint16_t>(24); })),
      settings(given) {
  if (settings.endpoint.host.empty()) settings.endpoint.serial_device = folder / "port";
  server = std::make_unique<ModbusControllerServer>(settings, bench, faults);
  settings.endpoint = server->endpoint();
  link = new_link();
  // By TCP a client may think itself connected before the server has accepted it, which is an operation, too.
  link->read(settings.axes.at(BenchAxis::Turntable).position, "turntable position");
}

std::shared_ptr<ModbusLink> ModbusBench::new_link() const {
  return std::make_shared<ModbusLink>(settings.endpoint, real_clock);
}

std::unique_ptr<ModbusAxis> ModbusBench::axis(BenchAxis which) const {
  AxisLimits limits = bench->limits(which);
  limits.grace_s = 3.0 * kBenchHaste;
  return std::make_unique<ModbusAxis>(to_string(which), link, settings.axes.at(which), limits, bench_clock);
}

std::unique_ptr<ModbusLamp> ModbusBench::lamp(BenchLamp which) const {
  return std::make_unique<ModbusLamp>(to_string(which), link, settings.lamps.at(which), real_clock);
}

std::unique_ptr<ModbusSafety> ModbusBench::safety() const {
  std::vector<ModbusLampMap> lamps;
  std::vector<ModbusAxisMap> axes;
  for (const auto& [which, map] : settings.lamps) lamps.push_back(map);
  for (const auto& [which, map] : settings.axes) axes.push_back(map);
  return std::make_unique<ModbusSafety>(connect_for_safety(link, real_clock), lamps, axes);
}

void ModbusBench::restart_server() {
  server.reset();
  server = std::make_unique<ModbusControllerServer>(settings, bench, faults);
}

std::string message_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const std::exception& error) {
    return error.what();
  }
  ADD_FAILURE() << "threw nothing";
  return "";
}

double seconds_of(const std::function<void()>& action) {
  const SystemClock clock;
  const double start_s = clock.now_s();
  action();
  return clock.now_s() - start_s;
}

}  // namespace lumitexel
