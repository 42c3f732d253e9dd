// Everything a capture needs, read and checked: what `plan` validates and `capture` then uses.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "rig/capture_plan.h"
#include "rig/console/rig_backend.h"
#include "rig/rig_description.h"
#include "rig/shot.h"

namespace lumitexel {

struct CaptureInputs {
  RigDescription rig;
  CapturePlan plan;
  std::vector<Shot> shots;
  RigBackend backend;
  std::map<std::string, std::string> documents;  // rig.toml, rig.path, plan.toml, mesh.ply (with views): as the session keeps them
};

// Throws BadInput naming file and key or view for anything that cannot be used, a view without the mesh in its picture
// included. Connects to nothing, moves nothing. mesh_file: instead of the plan's mesh; empty: the plan's.
CaptureInputs read_capture_inputs(const std::string& rig_file, const std::string& plan_file,
                                  const std::string& mesh_file = {});

}  // namespace lumitexel
