// [hardware.camera] of a still camera:
//
//   driver = "gphoto2"
//   model = "PTP/IP Camera"             # libgphoto2's name; only on USB may it be left out
//   port = "ptpip:192.168.1.7"          # or "usb:", "usb:001,004"; on ptpip two ports may follow: ":15740:15740"
//   exposure_setting, gain_setting, frame_name_setting = "…"      # what libgphoto2 calls them
//   iso_at_0_db, answer_timeout_s, reconnect_timeout_s = …
//   [hardware.camera.fixed_settings]    # made once on connecting
//   imagequality = "RAW"
#include <algorithm>
#include <cctype>
#include <sstream>

#include "rig/hardware_description.h"
#include "rig/toml_table.h"

namespace lumitexel {
namespace {

void read_if_there(const TomlTable& table, const std::string& key, std::string& value) {
  if (table.has(key)) value = table.string(key);
}

void read_if_there(const TomlTable& table, const std::string& key, double& value) {
  if (table.has(key)) value = table.number(key, NumberRange::positive());
}

void check_port(const TomlTable& table, const GphotoConnection& connection) {
  const std::string& port = connection.port;
  const bool over_ip = port.starts_with("ptpip:");
  if (!over_ip && !port.starts_with("usb:")) table.reject("port", port, "\"usb:…\" or \"ptpip:ADDRESS\"");
  // libgphoto2 takes a single port for the address's last part.
  const auto colons = std::count(port.begin(), port.end(), ':');
  if (over_ip && colons != 1 && colons != 3) {
    table.reject("port", port, "\"ptpip:ADDRESS\" or \"ptpip:ADDRESS:COMMAND_PORT:EVENT_PORT\"");
  }
  std::istringstream parts(port);
  std::string part;
  for (int i = 0; over_ip && std::getline(parts, part, ':'); ++i) {
    const bool number = !part.empty() && part.size() <= 5 && std::all_of(part.begin(), part.end(), ::isdigit);
    if (i >= 2 && !(number && std::stoi(part) >= 1 && std::stoi(part) <= 65535)) {
      table.reject("port", port, "ports from 1 to 65535");
    }
  }
  if (over_ip && connection.model.empty()) {
    table.reject("model", "missing",
                 "libgphoto2's name for the camera, such as \"PTP/IP Camera\": only USB is searched");
  }
}

}  // namespace

GphotoConnection read_gphoto_connection(const TomlTable& table) {
  GphotoConnection connection;
  if (table.has("driver") && table.string("driver") != "gphoto2") {
    table.reject("driver", table.string("driver"), "\"gphoto2\"");
  }
  read_if_there(table, "model", connection.model);
  read_if_there(table, "port", connection.port);
  read_if_there(table, "exposure_setting", connection.exposure_setting);
  read_if_there(table, "gain_setting", connection.gain_setting);
  read_if_there(table, "frame_name_setting", connection.frame_name_setting);
  read_if_there(table, "iso_at_0_db", connection.iso_at_0_db);
  read_if_there(table, "answer_timeout_s", connection.answer_timeout_s);
  read_if_there(table, "reconnect_timeout_s", connection.reconnect_timeout_s);
  if (table.has("fixed_settings")) {
    const TomlTable fixed = table.table("fixed_settings");
    for (const std::string& setting : fixed.keys()) connection.fixed_settings[setting] = fixed.string(setting);
  }
  table.reject_unread();
  check_port(table, connection);
  return connection;
}

}  // namespace lumitexel
