// How a rig's devices are connected: the [hardware] table of its file. Nothing here needs code for a new controller:
// its registers are data.
//
//   [hardware.camera]            driver = "aravis" | "gphoto2", and what that driver needs
//   [hardware.controllers.NAME]  a Modbus controller: TCP or RTU
//   [hardware.turntable], [hardware.light_azimuth], [hardware.light_elevation]     an axis's registers, controller = NAME
//   [hardware.point_light], [hardware.ring_flash], [hardware.backlight]            a lamp's
#pragma once

#include <map>
#include <string>
#include <variant>

#include "drivers/aravis/aravis_connection.h"
#include "drivers/gphoto/gphoto_connection.h"
#include "drivers/modbus/register_map.h"

namespace lumitexel {

class TomlTable;

struct HardwareDescription {
  std::variant<AravisConnection, GphotoConnection> camera;
  std::map<std::string, ModbusEndpoint> controllers;  // by name
  ModbusAxisMap turntable, light_azimuth, light_elevation;
  ModbusLampMap point_light, ring_flash, backlight;
};

// hardware_toml: RigDescription's. Throws BadInput naming `where`, line and key.
HardwareDescription parse_hardware(const std::string& hardware_toml, const std::string& where);

// Parts of it, each in a file of its own (rig/hardware_*.cpp): the table's keys, every one checked, none left unread.
AravisConnection read_aravis_connection(const TomlTable& table);
GphotoConnection read_gphoto_connection(const TomlTable& table);
ModbusEndpoint read_modbus_endpoint(const TomlTable& table, const std::string& name);
ModbusAxisMap read_modbus_axis(const TomlTable& table, const std::map<std::string, ModbusEndpoint>& controllers);
ModbusLampMap read_modbus_lamp(const TomlTable& table, const std::map<std::string, ModbusEndpoint>& controllers);

}  // namespace lumitexel
