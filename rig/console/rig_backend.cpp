#include "rig/console/rig_backend.h"

#include "drivers/error.h"
#include "rig/console/recorded_rig.h"
#include "rig/hardware_devices.h"
#include "sim/simulated_rig.h"

namespace lumitexel {
namespace {

RigBackend simulated_rig(const RigDescription& rig, const std::string& where) {
  const std::shared_ptr<SimulatedWorld> world = build_world(rig, where);
  RigBackend backend;
  backend.connect = [rig, world](std::stop_token) { return make_simulated_devices(rig, world); };
  backend.scan = [world] { return scanned_mesh(*world); };
  backend.write_truth = [world, rig](const CapturePlan& plan, const std::filesystem::path& truth_directory) {
    write_truth(*world, rig, plan, truth_directory);
  };
  return backend;
}

RigBackend hardware_rig(const RigDescription& rig, const std::string& where) {
  RigBackend backend;
  backend.connect = [rig, hardware = parse_hardware(rig.hardware_toml, where)](std::stop_token stop) {
    return connect_hardware(rig, hardware, std::move(stop));
  };
  return backend;
}

}  // namespace

RigBackend rig_backend(const RigDescription& rig, const std::string& where) {
  if (rig.backend == "simulated") return simulated_rig(rig, where);
  if (rig.backend == "hardware") return hardware_rig(rig, where);
  if (rig.backend == "recorded") return recorded_rig(rig, where);
  throw BadInput(where + ": backend", "'" + rig.backend + "'", "simulated, hardware or recorded");
}

}  // namespace lumitexel
