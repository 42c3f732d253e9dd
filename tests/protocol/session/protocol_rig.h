// A small rig whose every device is served over its real protocol: a camera by GigE Vision or PTP/IP, turntable and lamps
// by Modbus TCP, the light's arm by Modbus RTU. Registers are those of config/rigs/loopback.toml; addresses are the rig's
// own, so that many rigs and several processes go side by side.
#pragma once

#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "rig/hardware_description.h"
#include "rig/rig_description.h"
#include "rig/rig_devices.h"
#include "sim/fault_source.h"
#include "sim/protocol/served_rig.h"
#include "sim/simulated_bench.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {

enum class CameraKind { Gige, Still };

struct ProtocolRigOptions {
  CameraKind camera = CameraKind::Gige;
  std::shared_ptr<FaultSource> faults = std::make_shared<NoFaults>();
  ServedRigOptions serving;
  int declared_latency_frames = 0;  // CameraLimits::settings_latency_frames of the description
  double speed_deg_per_s = 36000.0;
  bool frames_named = true;  // the GigE camera copies the shot's number into the frame's chunks
  std::uint64_t seed = 1;
};

// 32 x 24 pixels of 12 bits by GigE Vision, 14 bits RGGB by PTP/IP; settled in milliseconds.
RigDescription quick_rig(CameraKind camera, double speed_deg_per_s = 36000.0);

class ProtocolRig {
 public:
  // With a pattern of place, settings and key for pixels, and the state strip on.
  explicit ProtocolRig(const ProtocolRigOptions& options);
  // Over a bench of the caller's; options say the rest.
  ProtocolRig(const ProtocolRigOptions& options, const RigDescription& rig, std::shared_ptr<SimulatedBench> bench);

  RigDevices connect(std::stop_token stop = {}) const;

  // What a person does at the rig after a pause: frees the axes, changes the lamps.
  void mend();
  // Whether all lamps are dark and all axes stand.
  bool is_at_rest() const;

  const RigDescription& rig() const { return rig_; }
  SimulatedBench& bench() { return *bench_; }
  const ServedRig& served() const { return *served_; }

 private:
  void describe(const ProtocolRigOptions& options);
  void place_at(const std::string& address);

  TemporaryFolder folder_;  // of the serial port's name
  RigDescription rig_;
  HardwareDescription hardware_;
  std::shared_ptr<SimulatedBench> bench_;
  std::unique_ptr<ServedRig> served_;
};

// libgphoto2 loads all its drivers for each connection; from here on until the process ends, it is offered one alone.
void offer_only_the_ptp_driver();

}  // namespace lumitexel
