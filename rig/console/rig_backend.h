// From a rig's description to something that can take pictures. The one place that knows which backends there are.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "processing/surface/mesh.h"
#include "rig/capture_plan.h"
#include "rig/rig_description.h"
#include "rig/rig_devices.h"

namespace lumitexel {

struct RigBackend {
  RigDevices devices;
  // The coarse mesh for plans with mesh = "scan"; empty if this backend has no scanner.
  std::function<Mesh()> scan;
  // Writes what a simulated world knows to be true; empty for rigs that do not know.
  std::function<void(const CapturePlan& plan, const std::filesystem::path& truth_directory)> write_truth;
};

// Throws BadInput naming `where` for a backend that does not exist, and what the backend throws on connecting.
RigBackend connect_rig(const RigDescription& rig, const std::string& where);

}  // namespace lumitexel
