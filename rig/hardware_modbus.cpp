// Modbus controllers, axes and lamps in a rig's [hardware] table. A register is an inline table:
//   position = { table = "input", address = 0, type = "int32", counts_per_unit = 1000 }
// and a command is one with the value to write: stop = { table = "coil", address = 8, value = 1 }.
#include <arpa/inet.h>

#include <limits>
#include <utility>

#include "rig/hardware_description.h"
#include "rig/toml_table.h"

namespace lumitexel {
namespace {

template <class Value>
using Names = std::initializer_list<std::pair<const char*, Value>>;

// The value that a key names, or `otherwise` if there is no such key.
template <class Value>
Value named(const TomlTable& table, const std::string& key, Names<Value> names, Value otherwise) {
  if (!table.has(key)) return otherwise;
  const std::string found = table.string(key);
  std::string all;
  for (const auto& [name, value] : names) {
    if (found == name) return value;
    all += (all.empty() ? "\"" : ", \"") + std::string(name) + '"';
  }
  table.reject(key, "\"" + found + '"', "one of " + all);
}

int integer_or(const TomlTable& table, const std::string& key, int min, int max, int otherwise) {
  return table.has(key) ? table.integer(key, min, max) : otherwise;
}

double number_or(const TomlTable& table, const std::string& key, const NumberRange& range, double otherwise) {
  return table.has(key) ? table.number(key, range) : otherwise;
}

bool is_bit(RegisterTable table) { return table == RegisterTable::Coil || table == RegisterTable::DiscreteInput; }

enum class Access { Read, Write };
enum class Holds { Anything, Number };

// A key's register; every key of its table but `value` is read.
ModbusRegister read_register_keys(const TomlTable& table, Access access, Holds holds) {
  using enum RegisterTable;
  ModbusRegister where;
  where.table =
      access == Access::Write
          ? named(table, "table", {{"coil", Coil}, {"holding", Holding}}, where.table)
          : named(table, "table", {{"coil", Coil}, {"discrete", DiscreteInput}, {"holding", Holding}, {"input", Input}},
                  where.table);
  if (is_bit(where.table)) {
    if (holds == Holds::Number) table.reject("table", "a single bit", "\"holding\" or \"input\": this is a number");
    where.type = named(table, "type", {{"bit", RegisterType::Bit}}, RegisterType::Bit);
    where.address = table.integer("address", 0, 65535);
    return where;
  }
  where.type = named(table, "type",
                     {{"int16", RegisterType::Int16}, {"uint16", RegisterType::Uint16}, {"int32", RegisterType::Int32},
                      {"uint32", RegisterType::Uint32}, {"float32", RegisterType::Float32}},
                     where.type);
  const bool wide = where.type != RegisterType::Int16 && where.type != RegisterType::Uint16;
  where.address = table.integer("address", 0, wide ? 65534 : 65535);
  where.counts_per_unit = number_or(table, "counts_per_unit", NumberRange::finite(), where.counts_per_unit);
  if (where.counts_per_unit == 0.0) table.reject("counts_per_unit", "0", "a number other than 0");
  where.offset_counts = number_or(table, "offset_counts", NumberRange::finite(), where.offset_counts);
  return where;
}

ModbusRegister read_register(const TomlTable& device, const std::string& key, Access access,
                             Holds holds = Holds::Anything) {
  const TomlTable table = device.table(key);
  const ModbusRegister where = read_register_keys(table, access, holds);
  table.reject_unread();
  return where;
}

std::optional<ModbusRegister> read_optional_register(const TomlTable& device, const std::string& key) {
  if (!device.has(key)) return std::nullopt;
  return read_register(device, key, Access::Read);
}

std::optional<ModbusCommand> read_optional_command(const TomlTable& device, const std::string& key) {
  if (!device.has(key)) return std::nullopt;
  const TomlTable table = device.table(key);
  ModbusCommand command;
  command.where = read_register_keys(table, Access::Write, Holds::Anything);
  command.value = number_or(table, "value", NumberRange::finite(), command.value);
  if (is_bit(command.where.table) && command.value != 0.0 && command.value != 1.0) {
    table.reject("value", std::to_string(command.value), "0 or 1, which is what a coil holds");
  }
  table.reject_unread();
  return command;
}

std::string read_controller(const TomlTable& table, const std::map<std::string, ModbusEndpoint>& controllers) {
  const std::string name = table.string("controller");
  if (controllers.contains(name)) return name;
  std::string all;
  for (const auto& [known, endpoint] : controllers) all += (all.empty() ? "" : ", ") + known;
  table.reject("controller", "\"" + name + '"',
               all.empty() ? "a table [hardware.controllers." + name + "]" : "one of [hardware.controllers]: " + all);
}

void read_tcp(const TomlTable& table, ModbusEndpoint& endpoint) {
  endpoint.host = table.string("host");
  in_addr address{};
  if (inet_pton(AF_INET, endpoint.host.c_str(), &address) != 1) {
    table.reject("host", "\"" + endpoint.host + '"',
                 "an IPv4 address such as 192.168.1.20 (looking up a name has no deadline)");
  }
  endpoint.port = integer_or(table, "port", 1, 65535, endpoint.port);
  endpoint.unit_id = integer_or(table, "unit_id", 0, 255, endpoint.unit_id);
  // libmodbus knows 255, "the device itself", and what a serial line behind a gateway may have.
  if (endpoint.unit_id > 247 && endpoint.unit_id < 255) {
    table.reject("unit_id", std::to_string(endpoint.unit_id), "0 to 247, or 255");
  }
}

void read_rtu(const TomlTable& table, ModbusEndpoint& endpoint) {
  endpoint.serial_device = table.string("serial_device");
  // The rates that a serial port can be set to; libmodbus would quietly take 9600 for any other.
  const std::string rates = "one of 1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600";
  endpoint.baud = integer_or(table, "baud", 1200, 921600, endpoint.baud);
  bool known = false;
  for (const int baud : {1200, 2400, 4800, 9600, 19200, 38400, 57600, 115200, 230400, 460800, 921600}) {
    known = known || baud == endpoint.baud;
  }
  if (!known) table.reject("baud", std::to_string(endpoint.baud), rates);
  endpoint.parity = named(table, "parity", {{"none", 'N'}, {"even", 'E'}, {"odd", 'O'}}, endpoint.parity);
  endpoint.stop_bits = integer_or(table, "stop_bits", 1, 2, endpoint.stop_bits);
  endpoint.unit_id = integer_or(table, "unit_id", 1, 247, endpoint.unit_id);
}

}  // namespace

ModbusEndpoint read_modbus_endpoint(const TomlTable& table, const std::string& name) {
  ModbusEndpoint endpoint;
  endpoint.name = name;
  const std::string transport = table.string("transport");
  if (transport == "tcp") read_tcp(table, endpoint);
  else if (transport == "rtu") read_rtu(table, endpoint);
  else table.reject("transport", "\"" + transport + '"', "\"tcp\" or \"rtu\"");
  endpoint.word_order =
      named(table, "word_order", {{"high_first", WordOrder::HighFirst}, {"low_first", WordOrder::LowFirst}},
            endpoint.word_order);
  endpoint.response_timeout_s =
      number_or(table, "response_timeout_s", NumberRange::between(0.001, 10.0), endpoint.response_timeout_s);
  endpoint.give_up_s = number_or(table, "give_up_s", NumberRange::between(0.0, 600.0), endpoint.give_up_s);
  endpoint.watchdog = read_optional_command(table, "watchdog");
  if (endpoint.watchdog || !table.has("watchdog_period_s")) {
    endpoint.watchdog_period_s =
        number_or(table, "watchdog_period_s", NumberRange::between(0.01, 3600.0), endpoint.watchdog_period_s);
  } else {
    table.reject("watchdog_period_s", "given without a watchdog", "watchdog = { … }, the register to write, beside it");
  }
  table.reject_unread();
  return endpoint;
}

ModbusAxisMap read_modbus_axis(const TomlTable& table, const std::map<std::string, ModbusEndpoint>& controllers) {
  ModbusAxisMap axis;
  axis.controller = read_controller(table, controllers);
  axis.position = read_register(table, "position", Access::Read, Holds::Number);
  axis.target = read_register(table, "target", Access::Write, Holds::Number);
  axis.start = read_optional_command(table, "start");
  axis.stop = read_optional_command(table, "stop");
  if (!axis.stop) table.reject("stop", "missing", "the command that stops this axis: the safety lane needs it");
  axis.home = read_optional_command(table, "home");
  axis.moving = read_optional_register(table, "moving");
  axis.homed = read_optional_register(table, "homed");
  axis.fault = read_optional_register(table, "fault");
  axis.tolerance = number_or(table, "tolerance_deg", NumberRange::positive(), axis.tolerance);
  axis.home_timeout_s = number_or(table, "home_timeout_s", NumberRange::positive(), axis.home_timeout_s);
  table.reject_unread();
  return axis;
}

ModbusLampMap read_modbus_lamp(const TomlTable& table, const std::map<std::string, ModbusEndpoint>& controllers) {
  ModbusLampMap lamp;
  lamp.controller = read_controller(table, controllers);
  lamp.output = read_register(table, "output", Access::Write);
  lamp.lit = read_optional_register(table, "lit");
  lamp.fault = read_optional_register(table, "fault");
  lamp.settle_s = number_or(table, "settle_s", NumberRange::non_negative(), lamp.settle_s);
  table.reject_unread();
  return lamp;
}

}  // namespace lumitexel
