// All devices that a rig's [hardware] table names, simulated and served over their real protocols at the addresses that
// it gives, over one bench: whoever connects by that table, or by any client, meets the simulated rig.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "rig/hardware_description.h"
#include "sim/fault_source.h"
#include "sim/protocol/gige/gige_camera_options.h"
#include "sim/simulated_bench.h"

namespace lumitexel {

class GigeCameraServer;
class ModbusControllerServer;
class PtpCameraServer;

// What the rig's description does not say about how its devices behave.
struct ServedRigOptions {
  GigeCameraOptions gige;             // the address is the description's
  double controller_late_by_s = 0.45;  // Fault::LateReply of a controller: more than its client waits
  double ptp_late_by_s = 3.0;          // of a still camera: more than libgphoto2 waits
};

class ServedRig {
 public:
  // Serves until destroyed. Throws BadInput, naming the key, for an address that is not of this machine's own 127.0.0.0/8
  // or cannot be bound: a simulator must never answer where a real device is looked for.
  ServedRig(const HardwareDescription& hardware, std::shared_ptr<SimulatedBench> bench,
            std::shared_ptr<FaultSource> faults, const ServedRigOptions& options = {});
  ~ServedRig();

  // One line per device: what it is, where it is.
  const std::vector<std::string>& places() const { return places_; }
  const ModbusControllerServer& controller(const std::string& name) const { return *controllers_.at(name); }

 private:
  void serve_camera(const HardwareDescription& hardware, const std::shared_ptr<SimulatedBench>& bench,
                    const std::shared_ptr<FaultSource>& faults);
  void serve_controller(const std::string& name, const HardwareDescription& hardware,
                        const std::shared_ptr<SimulatedBench>& bench, const std::shared_ptr<FaultSource>& faults);

  ServedRigOptions options_;
  std::unique_ptr<GigeCameraServer> gige_;
  std::unique_ptr<PtpCameraServer> ptp_;
  std::map<std::string, std::unique_ptr<ModbusControllerServer>> controllers_;
  std::vector<std::string> places_;
};

}  // namespace lumitexel
