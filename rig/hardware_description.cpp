#include "rig/hardware_description.h"

#include "drivers/error.h"
#include "rig/toml_table.h"

namespace lumitexel {
namespace {

std::variant<AravisConnection, GphotoConnection> read_camera(const TomlTable& table) {
  const std::string driver = table.string("driver");
  if (driver == "aravis") return read_aravis_connection(table);
  if (driver == "gphoto2") return read_gphoto_connection(table);
  table.reject("driver", "'" + driver + "'", "\"aravis\" (GigE Vision, USB3 Vision) or \"gphoto2\" (still cameras)");
}

}  // namespace

HardwareDescription parse_hardware(const std::string& hardware_toml, const std::string& where) {
  const TomlTable root = TomlTable::parse(hardware_toml, where);
  if (!root.has("hardware")) {
    throw BadInput(where + ": hardware", "no such table", "[hardware] with the devices' connections");
  }
  const TomlTable table = root.table("hardware");
  HardwareDescription hardware{read_camera(table.table("camera")), {}, {}, {}, {}, {}, {}, {}};
  const TomlTable controllers = table.table("controllers");
  for (const std::string& name : controllers.keys()) {
    hardware.controllers[name] = read_modbus_endpoint(controllers.table(name), name);
  }
  hardware.turntable = read_modbus_axis(table.table("turntable"), hardware.controllers);
  hardware.light_azimuth = read_modbus_axis(table.table("light_azimuth"), hardware.controllers);
  hardware.light_elevation = read_modbus_axis(table.table("light_elevation"), hardware.controllers);
  hardware.point_light = read_modbus_lamp(table.table("point_light"), hardware.controllers);
  hardware.ring_flash = read_modbus_lamp(table.table("ring_flash"), hardware.controllers);
  hardware.backlight = read_modbus_lamp(table.table("backlight"), hardware.controllers);
  table.reject_unread();
  return hardware;
}

}  // namespace lumitexel
