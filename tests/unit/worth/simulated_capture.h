// A simulated session, captured in this process into a folder, and the world that it was captured in.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "rig/capture_plan.h"
#include "rig/session_store.h"
#include "sim/simulated_world.h"

namespace lumitexel {

struct SimulatedCapture {
  std::filesystem::path rig, plan;
  double scale = 1.0;             // of the picture's sides
  std::string simulation_toml{};  // lines for the rig's [simulation] table; they win over the file's
};

struct CapturedWorld {
  std::shared_ptr<const SimulatedWorld> world;
  CapturePlan plan;
  SessionStore session;  // in folder/session, its truth under folder/session/truth
};

// `seed` of the noise, of the object's pattern and of all else that the simulation draws. Throws what reading the files, building the world and capturing throw.
CapturedWorld capture_simulated(const SimulatedCapture& what, int seed, const std::filesystem::path& folder);

}  // namespace lumitexel
