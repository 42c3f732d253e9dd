// The rig as it really stands: what its description says, off by the simulation's hidden errors.
#pragma once

#include <Eigen/Geometry>

#include "rig/rig_description.h"
#include "sim/simulation_settings.h"

namespace lumitexel {

// Lens, camera pose, turntable axis and gray card (with its tags) displaced; everything else as described.
RigDescription true_rig(const RigDescription& described, const SimulationSettings& settings);

// Where the operator really put the object: from the mesh's frame to the table's.
Eigen::Isometry3d true_table_from_mesh(const SimulationSettings& settings);

// Relative illumination of the sensor at a pixel position: 1 + a r^2 + b r^4 + c r^6, r the distance from the principal
// point over half the picture's diagonal.
double vignetting_at(const CameraDescription& camera, const Eigen::Vector3d& coefficients, double x_px, double y_px);

}  // namespace lumitexel
