// A GigE Vision camera on a loopback address, over a SimulatedBench: what any client of that protocol can discover,
// configure, trigger and stream from. A software trigger exposes on the bench; its pixels are the bench's, unchanged.
//
// Its sensor is the bench's camera. Beyond the standard's features it has FrameName, an integer of 64 bits that names
// the next frames: the noise is drawn by it, and it is in each frame's chunks. Faults are asked for as device "camera",
// operations "read_register", "write_register", "read_memory", "write_memory", "accept control", "trigger", "frame".
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "sim/fault_source.h"
#include "sim/protocol/gige/gige_camera_options.h"
#include "sim/simulated_bench.h"

namespace lumitexel {

class GigeCameraServer {
 public:
  // Serves until destroyed. Throws Disconnected if the address cannot be bound.
  GigeCameraServer(std::shared_ptr<SimulatedBench> bench, const GigeCameraOptions& options,
                   std::shared_ptr<FaultSource> faults = std::make_shared<NoFaults>());
  ~GigeCameraServer();

  const std::string& address() const;
  void withdraw_control();  // the client that has control loses it
  void reboot();            // silent for options.silence_s, then as after power on

  std::uint64_t frames_sent() const;
  std::uint64_t packets_lost() const;
  std::uint64_t packets_resent() const;

 private:
  class Device;
  std::unique_ptr<Device> device_;
};

}  // namespace lumitexel
