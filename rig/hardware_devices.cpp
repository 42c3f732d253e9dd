#include "rig/hardware_devices.h"

#include <map>

#include "drivers/aravis/aravis_camera.h"
#include "drivers/gphoto/gphoto_camera.h"
#include "drivers/modbus/modbus_axis.h"
#include "drivers/modbus/modbus_lamp.h"
#include "drivers/modbus/modbus_safety.h"

namespace lumitexel {
namespace {

constexpr double kKicksPerWatchdogPeriod = 4.0;  // three may come late

class ModbusSafetyChannel final : public SafetyChannel {
 public:
  // shared: the line is the devices' own, a serial one.
  ModbusSafetyChannel(std::string name, ModbusSafety safety, bool shared)
      : name_(std::move(name)), safety_(std::move(safety)), shared_(shared) {}
  std::string name() const override { return name_; }
  bool make_safe() noexcept override { return safety_.make_safe(); }
  // On a shared line the devices' requests find a dead controller, with more patience than a keep-alive has.
  bool keep_alive() noexcept override { return safety_.kick_watchdog() || shared_; }

 private:
  std::string name_;
  ModbusSafety safety_;
  bool shared_;
};

using Links = std::map<std::string, std::shared_ptr<ModbusLink>>;

std::unique_ptr<Camera> connect_camera(const RigDescription& rig, const HardwareDescription& hardware,
                                       const std::shared_ptr<Clock>& clock) {
  if (const auto* aravis = std::get_if<AravisConnection>(&hardware.camera)) {
    return std::make_unique<AravisCamera>(*aravis, rig.camera.limits, clock);
  }
  return std::make_unique<GphotoCamera>(std::get<GphotoConnection>(hardware.camera), rig.camera.limits, clock);
}

std::unique_ptr<Axis> connect_axis(const std::string& name, const ModbusAxisMap& map, const AxisLimits& limits,
                                   const Links& links, const std::shared_ptr<Clock>& clock, std::stop_token stop) {
  auto axis = std::make_unique<ModbusAxis>(name, links.at(map.controller), map, limits, clock);
  axis->home(std::move(stop));
  return axis;
}

std::unique_ptr<SafetyLane> open_safety_lane(const HardwareDescription& hardware, const Links& links,
                                             const std::shared_ptr<Clock>& clock, std::stop_token stop) {
  std::vector<std::unique_ptr<SafetyChannel>> channels;
  double period_s = 1.0;
  for (const auto& [name, link] : links) {
    ModbusSafety safety(connect_for_safety(link, clock, stop),
                        {hardware.point_light, hardware.ring_flash, hardware.backlight},
                        {hardware.turntable, hardware.light_azimuth, hardware.light_elevation});
    const ModbusEndpoint& endpoint = link->endpoint();
    channels.push_back(std::make_unique<ModbusSafetyChannel>("controller " + name, std::move(safety),
                                                             endpoint.host.empty()));
    if (endpoint.watchdog) period_s = std::min(period_s, endpoint.watchdog_period_s / kKicksPerWatchdogPeriod);
  }
  return std::make_unique<SafetyLane>(std::move(channels),
                                      std::chrono::milliseconds(static_cast<int>(1000.0 * period_s)));
}

}  // namespace

RigDevices connect_hardware(const RigDescription& rig, const HardwareDescription& hardware, std::stop_token stop) {
  RigDevices devices;
  devices.clock = std::make_shared<SystemClock>();
  Links links;
  for (const auto& [name, endpoint] : hardware.controllers) {
    links[name] = std::make_shared<ModbusLink>(endpoint, devices.clock, stop);
  }
  // Before anything moves or lights up.
  devices.safety = open_safety_lane(hardware, links, devices.clock, stop);
  const auto lamp = [&](const char* name, const ModbusLampMap& map) {
    auto made = std::make_unique<ModbusLamp>(name, links.at(map.controller), map, devices.clock);
    made->switch_to(false, stop);
    return made;
  };
  devices.point_light = lamp("point light", hardware.point_light);
  devices.ring_flash = lamp("ring flash", hardware.ring_flash);
  devices.backlight = lamp("backlight", hardware.backlight);
  AxisLimits table;
  table.max = 360.0;
  table.wraps = true;
  table.speed = rig.turntable.speed_deg_per_s;
  table.settle_s = rig.turntable.settle_s;
  const auto arm = [&](double min, double max) {
    AxisLimits limits;
    limits.min = min;
    limits.max = max;
    limits.speed = rig.light_positioner.speed_deg_per_s;
    limits.settle_s = rig.light_positioner.settle_s;
    return limits;
  };
  const LightPositionerDescription& light = rig.light_positioner;
  devices.turntable = connect_axis("turntable", hardware.turntable, table, links, devices.clock, stop);
  devices.light_azimuth = connect_axis("light azimuth", hardware.light_azimuth,
                                       arm(light.azimuth_min_deg, light.azimuth_max_deg), links, devices.clock, stop);
  devices.light_elevation =
      connect_axis("light elevation", hardware.light_elevation, arm(light.elevation_min_deg, light.elevation_max_deg),
                   links, devices.clock, stop);
  devices.camera = connect_camera(rig, hardware, devices.clock);
  return devices;
}

}  // namespace lumitexel
