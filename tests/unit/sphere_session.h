// A calibrated session with closed-form truth: a diffuse sphere, photographed without noise.
#pragma once

#include "processing/calibration/calibrated_session.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {

inline constexpr double kSphereAlbedo = 0.6;

// Latitude-longitude sphere around the origin, outside counter-clockwise.
Mesh sphere_mesh(double radius_m, int rings);

// A view from `eye` towards the origin, 160 x 120 pixels, lit from `light` with intensity 10 in every channel.
View view_of_origin(const std::string& name, const Eigen::Vector3d& eye, const Eigen::Vector3d& light);

// Photographs of a diffuse object of any shape. Renders each view's photograph (one radiance a pixel centre, albedo / pi * I cos / d^2 with the mesh's own normals,
// 0 in shadow and on the background) into `folder`.
CalibratedSession diffuse_session(Mesh mesh, std::vector<View> views, const TemporaryFolder& folder);
// The same of sphere_mesh(0.1, 60).
CalibratedSession sphere_session(std::vector<View> views, const TemporaryFolder& folder);

}  // namespace lumitexel
