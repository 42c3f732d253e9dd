#include <gtest/gtest.h>

#include "rig/hardware_description.h"
#include "rig/toml_table.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/small_rig.h"

namespace lumitexel {
namespace {

const char* const kTcp = R"(transport = "tcp"
host = "192.168.1.20"
unit_id = 3
word_order = "low_first"
response_timeout_s = 0.2
give_up_s = 5
watchdog = { table = "holding", address = 20, value = 7 }
watchdog_period_s = 1.5
)";

const char* const kRtu = R"(transport = "rtu"
serial_device = "/dev/ttyUSB0"
baud = 19200
parity = "even"
stop_bits = 2
unit_id = 17
)";

const char* const kAxis = R"(controller = "bench"
position = { table = "input", address = 0, type = "int32", counts_per_unit = 1000 }
target = { table = "holding", address = 8, type = "float32", offset_counts = -3.5 }
start = { table = "coil", address = 12 }
stop = { table = "holding", address = 10, value = 2 }
moving = { table = "discrete", address = 2 }
fault = { table = "input", address = 100 }
tolerance_deg = 0.02
)";

const char* const kLamp = R"(controller = "bench"
output = { table = "coil", address = 5 }
lit = { table = "discrete", address = 16 }
settle_s = 0.3
)";

ModbusEndpoint endpoint(const std::string& toml) {
  return read_modbus_endpoint(TomlTable::parse(toml, "rig.toml"), "bench");
}
const std::map<std::string, ModbusEndpoint> kControllers{{"arm", {}}, {"bench", {}}};
ModbusAxisMap axis(const std::string& toml) {
  return read_modbus_axis(TomlTable::parse(toml, "rig.toml"), kControllers);
}
ModbusLampMap lamp(const std::string& toml) {
  return read_modbus_lamp(TomlTable::parse(toml, "rig.toml"), kControllers);
}

TEST(HardwareModbus, ReadsATcpController) {
  const ModbusEndpoint read = endpoint(kTcp);
  EXPECT_EQ(read.name, "bench");
  EXPECT_EQ(read.host, "192.168.1.20");
  EXPECT_EQ(read.port, 502);
  EXPECT_EQ(read.unit_id, 3);
  EXPECT_EQ(read.word_order, WordOrder::LowFirst);
  EXPECT_EQ(read.response_timeout_s, 0.2);
  EXPECT_EQ(read.give_up_s, 5.0);
  ASSERT_TRUE(read.watchdog);
  EXPECT_EQ(read.watchdog->where.address, 20);
  EXPECT_EQ(read.watchdog->value, 7.0);
  EXPECT_EQ(read.watchdog_period_s, 1.5);
}

TEST(HardwareModbus, ReadsASerialControllerWithDefaults) {
  const ModbusEndpoint read = endpoint(kRtu), defaults;
  EXPECT_TRUE(read.host.empty());
  EXPECT_EQ(read.serial_device, "/dev/ttyUSB0");
  EXPECT_EQ(read.baud, 19200);
  EXPECT_EQ(read.parity, 'E');
  EXPECT_EQ(read.stop_bits, 2);
  EXPECT_EQ(read.unit_id, 17);
  EXPECT_EQ(read.word_order, WordOrder::HighFirst);
  EXPECT_EQ(read.response_timeout_s, defaults.response_timeout_s);
  EXPECT_EQ(read.give_up_s, defaults.give_up_s);
  EXPECT_FALSE(read.watchdog);
}

TEST(HardwareModbus, ReadsAxesAndLamps) {
  const ModbusAxisMap read = axis(kAxis), defaults;
  EXPECT_EQ(read.controller, "bench");
  EXPECT_EQ(read.position.table, RegisterTable::Input);
  EXPECT_EQ(read.position.type, RegisterType::Int32);
  EXPECT_EQ(read.position.counts_per_unit, 1000.0);
  EXPECT_EQ(read.target.address, 8);
  EXPECT_EQ(read.target.type, RegisterType::Float32);
  EXPECT_EQ(read.target.offset_counts, -3.5);
  ASSERT_TRUE(read.start && read.stop && read.moving && read.fault);
  EXPECT_EQ(read.start->where.table, RegisterTable::Coil);
  EXPECT_EQ(read.start->value, 1.0);
  EXPECT_EQ(read.stop->where.type, RegisterType::Uint16);
  EXPECT_EQ(read.stop->value, 2.0);
  EXPECT_EQ(read.moving->table, RegisterTable::DiscreteInput);
  EXPECT_EQ(read.moving->type, RegisterType::Bit);
  EXPECT_FALSE(read.home || read.homed);
  EXPECT_EQ(read.tolerance, 0.02);
  EXPECT_EQ(read.home_timeout_s, defaults.home_timeout_s);
  const ModbusLampMap light = lamp(kLamp);
  EXPECT_EQ(light.output.address, 5);
  ASSERT_TRUE(light.lit);
  EXPECT_EQ(light.lit->address, 16);
  EXPECT_FALSE(light.fault);
  EXPECT_EQ(light.settle_s, 0.3);
}

TEST(HardwareModbus, EveryMistakeInAControllerIsOneLineWithItsPlace) {
  const auto bad_tcp = [](const std::string& from, const std::string& to) { endpoint(with_replaced(kTcp, from, to)); };
  EXPECT_BAD_INPUT(bad_tcp("tcp", "udp"), "rig.toml:1: transport", "udp", "\"tcp\" or \"rtu\"");
  EXPECT_BAD_INPUT(bad_tcp("192.168.1.20", "bench.local"), "rig.toml:2: host", "bench.local", "IPv4");
  EXPECT_BAD_INPUT(bad_tcp("unit_id = 3", "unit_id = 250"), "rig.toml:3: unit_id", "250", "255");
  EXPECT_BAD_INPUT(bad_tcp("low_first", "little"), "rig.toml:4: word_order", "little", "\"high_first\", \"low_first\"");
  EXPECT_BAD_INPUT(bad_tcp("0.2", "0"), "response_timeout_s", "0.001");
  EXPECT_BAD_INPUT(bad_tcp("0.2", "nan"), "response_timeout_s", "nan");
  EXPECT_BAD_INPUT(bad_tcp("give_up_s = 5", "giveup_s = 5"), "rig.toml:6: giveup_s", "unknown key");
  EXPECT_BAD_INPUT(bad_tcp("unit_id = 3", "baud = 9600"), "baud", "unknown key");  // belongs to the other transport
  EXPECT_BAD_INPUT(bad_tcp("table = \"holding\"", "table = \"input\""), "watchdog.table", "input",
                   "\"coil\", \"holding\"");
  EXPECT_BAD_INPUT(bad_tcp("watchdog = {", "#"), "watchdog_period_s", "without a watchdog");
  const auto bad_rtu = [](const std::string& from, const std::string& to) { endpoint(with_replaced(kRtu, from, to)); };
  EXPECT_BAD_INPUT(bad_rtu("19200", "19201"), "rig.toml:3: baud", "19201", "115200");
  EXPECT_BAD_INPUT(bad_rtu("even", "mark"), "parity", "mark", "\"none\", \"even\", \"odd\"");
  EXPECT_BAD_INPUT(bad_rtu("stop_bits = 2", "stop_bits = 3"), "stop_bits", "3");
  EXPECT_BAD_INPUT(bad_rtu("17", "0"), "unit_id", "from 1 to 247");
  EXPECT_BAD_INPUT(bad_rtu("serial_device", "device"), "serial_device", "missing");
}

TEST(HardwareModbus, EveryMistakeInAMapIsOneLineWithItsPlace) {
  const auto bad_axis = [](const std::string& from, const std::string& to) { axis(with_replaced(kAxis, from, to)); };
  EXPECT_BAD_INPUT(bad_axis("\"bench\"", "\"bank\""), "rig.toml:1: controller", "bank", "arm, bench");
  EXPECT_BAD_INPUT(bad_axis("int32", "int64"), "rig.toml:2: position.type", "int64", "\"float32\"");
  EXPECT_BAD_INPUT(bad_axis("address = 0", "address = 65535"), "position.address", "65535", "65534");
  EXPECT_BAD_INPUT(bad_axis("address = 0", "address = \"0\""), "position.address", "whole number");
  EXPECT_BAD_INPUT(bad_axis("= 1000", "= 0"), "position.counts_per_unit", "other than 0");
  EXPECT_BAD_INPUT(bad_axis("\"input\"", "\"inputs\""), "position.table", "inputs", "\"discrete\"");
  EXPECT_BAD_INPUT(bad_axis("\"input\", address = 0", "\"coil\", address = 0"), "position.table", "single bit");
  EXPECT_BAD_INPUT(bad_axis("\"holding\", address = 8", "\"input\", address = 8"), "rig.toml:3: target.table", "input");
  EXPECT_BAD_INPUT(bad_axis("address = 12", "address = 12, value = 2"), "start.value", "0 or 1");
  EXPECT_BAD_INPUT(bad_axis("address = 2 }", "address = 2, type = \"uint16\" }"), "moving.type", "\"bit\"");
  EXPECT_BAD_INPUT(bad_axis("address = 2 }", "address = 2, counts_per_unit = 2 }"), "moving.counts_per_unit",
                   "unknown");
  EXPECT_BAD_INPUT(bad_axis("address = 100 }", "address = 100, value = 1 }"), "fault.value", "unknown key");
  EXPECT_BAD_INPUT(bad_axis("moving", "movng"), "rig.toml:6: movng", "unknown key");
  EXPECT_BAD_INPUT(bad_axis("tolerance_deg = 0.02", "tolerance_deg = 0"), "tolerance_deg", "positive");
  EXPECT_BAD_INPUT(bad_axis("target", "#"), "target", "missing");
  const auto bad_lamp = [](const std::string& from, const std::string& to) { lamp(with_replaced(kLamp, from, to)); };
  EXPECT_BAD_INPUT(bad_lamp("\"coil\"", "\"discrete\""), "output.table", "discrete", "\"coil\", \"holding\"");
  EXPECT_BAD_INPUT(bad_lamp("0.3", "-1"), "settle_s", "-1");
  EXPECT_BAD_INPUT(bad_lamp("lit", "on"), "on", "unknown key");
  EXPECT_BAD_INPUT(read_modbus_lamp(TomlTable::parse(kLamp, "rig.toml"), {}), "bench", "[hardware.controllers.bench]");
}

}  // namespace
}  // namespace lumitexel
