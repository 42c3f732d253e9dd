// A Modbus controller over the simulated bench, for any client: by TCP, several at once, or by RTU on a
// pseudo-terminal.
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "drivers/modbus/register_map.h"
#include "sim/fault_source.h"
#include "sim/protocol/modbus/simulated_controller.h"
#include "sim/simulated_bench.h"

namespace lumitexel {

struct ModbusServerSettings {
  // host: the address to listen at, port 0: a free one. Without host RTU: serial_device is the symbolic link to the
  // port that is made, empty: in the folder for temporary files.
  ModbusEndpoint endpoint;
  std::map<BenchAxis, ModbusAxisMap> axes;
  std::map<BenchLamp, ModbusLampMap> lamps;
  ControllerBehaviour behaviour;
  double late_by_s = 0.45;          // Fault::LateReply; should be more than the client's response_timeout_s
  bool knows_diagnostics = true;    // function 8, "return query data", on a serial line; else it says nothing to that
};

// Serves from construction to destruction. Faults, of the device "controller":
//   "read", "write", "diagnostics"  Mute, LateReply, Exception, Garbage, HalfReply, Disconnect; "write" also StuckAxis
//                                   where it starts a motion and LampFails where it lights a lamp
//   "accept" (TCP)                  Mute: accepted, but never answered; Disconnect: closed again at once
// Exception says busy, acknowledge or failure and leaves things undone; Mute and Disconnect strike before or after the
// request is carried out; the others have it carried out. Over RTU, Disconnect unplugs the port for 50 ms.
class ModbusControllerServer {
 public:
  // Throws Error if the address or the port cannot be had, OutOfRange as SimulatedController.
  ModbusControllerServer(const ModbusServerSettings& settings, std::shared_ptr<SimulatedBench> bench,
                         std::shared_ptr<FaultSource> faults);
  ~ModbusControllerServer();

  const ModbusEndpoint& endpoint() const;  // where it can be reached
  const SimulatedController& controller() const;

 private:
  class Serving;
  std::unique_ptr<Serving> serving_;
};

}  // namespace lumitexel
