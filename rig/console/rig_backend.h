// From a rig's description to something that can take pictures. The one place that knows which backends there are.
#pragma once

#include <filesystem>
#include <functional>
#include <stop_token>
#include <string>

#include "processing/surface/mesh.h"
#include "rig/capture_plan.h"
#include "rig/rig_description.h"
#include "rig/rig_devices.h"

namespace lumitexel {

struct RigBackend {
  // Until it is called nothing is connected and nothing moves. Throws what the devices throw.
  std::function<RigDevices(std::stop_token stop)> connect;
  // The coarse mesh for plans with mesh = "scan"; empty if this backend has no scanner.
  std::function<Mesh()> scan;
  // Writes what a simulated world knows to be true; empty for rigs that do not know.
  std::function<void(const CapturePlan& plan, const std::filesystem::path& truth_directory)> write_truth;
};

// Throws BadInput naming `where` for a backend that does not exist and for tables of it that are missing or wrong.
RigBackend rig_backend(const RigDescription& rig, const std::string& where);

}  // namespace lumitexel
