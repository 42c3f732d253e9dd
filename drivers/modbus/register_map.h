// What a Modbus controller's registers mean, as data.
#pragma once

#include <optional>
#include <string>

namespace lumitexel {

enum class RegisterTable { Coil, DiscreteInput, Holding, Input };
enum class RegisterType { Bit, Int16, Uint16, Int32, Uint32, Float32 };
enum class WordOrder { HighFirst, LowFirst };  // of a value in two registers

struct ModbusRegister {
  RegisterTable table = RegisterTable::Holding;
  int address = 0;                // 0-based, as on the wire
  RegisterType type = RegisterType::Uint16;
  double counts_per_unit = 1.0;   // value in units = (count - offset_counts) / counts_per_unit
  double offset_counts = 0.0;
};

// What to write to have something done, such as "stop".
struct ModbusCommand {
  ModbusRegister where;
  double value = 1.0;  // in the register's unit
};

struct ModbusEndpoint {
  std::string name;          // in messages: "controller bench"
  // TCP if host is not empty, else RTU.
  std::string host;
  int port = 502;
  std::string serial_device;  // "/dev/ttyUSB0"
  int baud = 115200;
  char parity = 'N';          // 'N', 'E', 'O'
  int stop_bits = 1;
  int unit_id = 1;
  WordOrder word_order = WordOrder::HighFirst;
  double response_timeout_s = 0.3;
  double give_up_s = 3.0;     // after so long without the controller, reconnecting all the while: Disconnected
  // A register that has to be written at least this often, or the controller switches everything off by itself.
  std::optional<ModbusCommand> watchdog;
  double watchdog_period_s = 0.5;
};

struct ModbusAxisMap {
  std::string controller;
  ModbusRegister position;              // where the axis is
  ModbusRegister target;                // writing it starts the motion, unless `start` is given
  std::optional<ModbusCommand> start, stop, home;
  std::optional<ModbusRegister> moving;  // not zero: it moves
  std::optional<ModbusRegister> homed;   // not zero: it knows where it is; homed on connecting if not
  std::optional<ModbusRegister> fault;   // not zero: a fault, its number
  double tolerance = 0.01;              // in the axis's unit
  double home_timeout_s = 60.0;
};

struct ModbusLampMap {
  std::string controller;
  ModbusRegister output;                 // 1 on, 0 off
  std::optional<ModbusRegister> lit;     // not zero: the lamp itself says that it shines
  std::optional<ModbusRegister> fault;
  double settle_s = 0.1;
};

}  // namespace lumitexel
