// The simulated rig: one world, and devices over it that implement the same interfaces as hardware, on virtual time.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "processing/surface/mesh.h"
#include "rig/capture_plan.h"
#include "rig/rig_description.h"
#include "rig/rig_devices.h"

namespace lumitexel {

class SimulatedBench;
class SimulatedWorld;

// Reads the rig's [simulation] table. `where` is the rig file's path: a mesh file is looked for relative to its folder.
// Throws BadInput naming `where` and the key.
std::shared_ptr<SimulatedWorld> build_world(const RigDescription& rig, const std::string& where);

// Devices over the world, with a virtual clock. A frame's pixels depend on the rig's seed, the frame_key given to
// Camera::shoot, the settings, the axes' positions, the lamps and the stage, and on nothing else: a shot that a resumed session
// takes is, bit for bit, the one that an uninterrupted session would have taken. Two shots differ in their noise if
// their keys do. Moves, settling, exposures and readout take their time on the clock.
RigDevices make_simulated_devices(const RigDescription& rig, std::shared_ptr<SimulatedWorld> world);
RigDevices make_simulated_devices(const std::shared_ptr<SimulatedBench>& bench);

// The bench whose camera sees the world; its noise is the same whatever devices lie between.
std::shared_ptr<SimulatedBench> make_rendered_bench(const RigDescription& rig, std::shared_ptr<SimulatedWorld> world,
                                                    std::shared_ptr<Clock> clock);

// What a scanner would deliver of the world's object: smoothed, decimated, in the table's frame.
Mesh scanned_mesh(const SimulatedWorld& world);

// The truth that tests and `evaluate` read, under SESSION/truth/. calibration.json, as `calibrate --json` prints it, in the
// mesh's frame (which the operator may have put anywhere on the table), and besides:
//   lights[]   intensity_w_per_sr, intensity (samples/s, the unit of the photographs), both along the lamp's axis and with the
//              drift at the middle shot of the view's bracket; axis; sensor_temperature_c
//   scale      value: the intensity (samples/s) while the card was photographed
//   vignetting [a, b, c] (sim/true_rig.h); response {family, curve}; lamp {pattern_exponent, pattern_tilt_deg, radius_m, drift}
//   camera_from_rig, turntable {axis_point_m, axis_direction}, card {centre_m, normal, up, lamp_strength}: in the rig's frame
//   table_from_world; boards [{placement, camera_from_board, bow_m}]. Poses are 4x4, row by row.
// mesh.ply is the true surface; and per view, at pixel centres, NAME_normal.exr (unit normals in the mesh's frame) and
// NAME_material.exr (1 for the first of simulation.materials; 0 outside the object). rig: as described, without its hidden
// errors. Throws Error if it cannot be written.
void write_truth(const SimulatedWorld& world, const RigDescription& rig, const CapturePlan& plan,
                 const std::filesystem::path& truth_directory);

}  // namespace lumitexel
