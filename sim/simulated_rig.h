// The simulated rig: one world, and devices over it that implement the same interfaces as hardware, on virtual time.
#pragma once

#include <filesystem>
#include <memory>

#include "processing/surface/mesh.h"
#include "rig/capture_plan.h"
#include "rig/rig_description.h"
#include "rig/rig_devices.h"

namespace lumitexel {

class SimulatedWorld;

// Reads the rig's [simulation] table. Throws BadInput naming `where` and the key.
std::shared_ptr<SimulatedWorld> build_world(const RigDescription& rig, const std::string& where);

// Devices over the world, with a VirtualClock. Frames depend only on the rig's seed, the shot's settings, the
// axes' positions, the lamps and how many frames of exactly these were taken before, so a resumed session gets the same pixels as an
// uninterrupted one.
RigDevices make_simulated_devices(const RigDescription& rig, std::shared_ptr<SimulatedWorld> world);

// What a scanner would deliver of the world's object: smoothed, decimated, in the table's frame.
Mesh scanned_mesh(const SimulatedWorld& world);

// The truth that tests and `evaluate` read, under SESSION/truth/: calibration.json (as `calibrate --json`
// prints it), mesh.ply (the true surface), and per view NAME_normal.exr (unit normals in the table's frame) and NAME_material.exr.
void write_truth(const SimulatedWorld& world, const RigDescription& rig, const CapturePlan& plan,
                 const std::filesystem::path& truth_directory);

}  // namespace lumitexel
