// What a Modbus controller does with its registers: the bench's axes and lamps under the addresses of a register map.
// Knows nothing of connections. Thread-safe.
#pragma once

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "drivers/modbus/register_map.h"
#include "sim/fault_source.h"
#include "sim/protocol/modbus/modbus_request.h"
#include "sim/simulated_bench.h"

namespace lumitexel {

struct ControllerBehaviour {
  bool homed = true;         // whether the axes know where they are when it is switched on
  int stuck_axis_fault = 0;  // what the fault register of an axis says while Fault::StuckAxis holds it; 0: nothing
  int lamp_fault = 0;        // likewise of a lamp after Fault::LampFails
  bool refuses_groups = false;  // takes coils only one by one (function 15 is illegal to it)
};

// A command to switch off or to stop that has arrived, or the watchdog's own.
struct ReceivedStop {
  std::string what;  // "point light off", "turntable stop"
  std::chrono::steady_clock::time_point at;
};

class SimulatedController {
 public:
  // The maps' `controller` is not looked at: give those of this one. Throws OutOfRange if a register cannot hold the
  // range of its axis.
  SimulatedController(std::shared_ptr<SimulatedBench> bench, const ModbusEndpoint& endpoint,
                      const std::map<BenchAxis, ModbusAxisMap>& axes, const std::map<BenchLamp, ModbusLampMap>& lamps,
                      const ControllerBehaviour& behaviour);

  // The bench's faults that could go with a request: StuckAxis if it starts a motion, LampFails if it lights a lamp.
  std::vector<Fault> possible_faults(const ModbusRequest& request) const;
  // Carries it out and gives the reply's PDU. fault: one of the possible ones, or None. A register that is not mapped,
  // half of a value, or writing what can only be read is an illegal address; a value that no command has, an illegal
  // value. In one request all is of one moment.
  Bytes answer(const Bytes& pdu, Fault fault);

  // Everything off if the watchdog register, once written, has not been written again in time. To be called often.
  void check_watchdog(std::chrono::steady_clock::time_point now);

  std::vector<ReceivedStop> received_stops() const;
  int watchdog_trips() const;

 private:
  struct Field {
    ModbusRegister where;
    std::function<double()> value;      // empty: reads as 0
    std::function<bool(double)> take;   // empty: read-only; false: no such command
    std::function<Fault(double)> risk;  // which of the bench's faults writing this may end in
    std::function<void()> suffer;       // makes it so
  };
  void add_axis(BenchAxis axis, const ModbusAxisMap& map);
  void add_axis_state(BenchAxis axis, const ModbusAxisMap& map);
  void add_lamp(BenchLamp lamp, const ModbusLampMap& map);
  void add_command(const ModbusCommand& command, std::function<void()> act, Field field = {});
  bool is_homed(BenchAxis axis);
  void switch_off_everything(const std::string& why);
  void record(const std::string& what) { stops_.push_back({what, std::chrono::steady_clock::now()}); }
  double value_in(const Field& field, const ModbusRequest& request) const;
  std::vector<const Field*> written_fields(const ModbusRequest& request) const;  // empty: not all of it is writable
  ModbusException write(const ModbusRequest& request, Fault fault);
  std::optional<std::vector<std::uint16_t>> read(const ModbusRequest& request) const;

  struct AxisState {
    bool homed = true, homing = false;
    double target = 0.0;
    int fault = 0;
  };
  struct LampState {
    bool commanded = false;
    int fault = 0;
  };

  std::shared_ptr<SimulatedBench> bench_;
  ModbusEndpoint endpoint_;
  ControllerBehaviour behaviour_;
  mutable std::mutex mutex_;
  std::vector<Field> fields_;
  std::map<BenchAxis, AxisState> axes_;
  std::map<BenchLamp, LampState> lamps_;
  std::vector<ReceivedStop> stops_;
  std::optional<std::chrono::steady_clock::time_point> last_kick_;
  int watchdog_trips_ = 0;
};

}  // namespace lumitexel
