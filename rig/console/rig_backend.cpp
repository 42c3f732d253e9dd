#include "rig/console/rig_backend.h"

#include "drivers/error.h"
#include "rig/console/recorded_rig.h"
#include "sim/simulated_rig.h"

namespace lumitexel {

RigBackend connect_rig(const RigDescription& rig, const std::string& where) {
  if (rig.backend == "recorded") return connect_recorded_rig(rig, where);
  if (rig.backend != "simulated") {
    throw BadInput(where + ": backend", "'" + rig.backend + "'", "simulated or recorded");
  }
  const std::shared_ptr<SimulatedWorld> world = build_world(rig, where);
  RigBackend backend;
  backend.devices = make_simulated_devices(rig, world);
  backend.scan = [world] { return scanned_mesh(*world); };
  backend.write_truth = [world, rig](const CapturePlan& plan, const std::filesystem::path& truth_directory) {
    write_truth(*world, rig, plan, truth_directory);
  };
  return backend;
}

}  // namespace lumitexel
