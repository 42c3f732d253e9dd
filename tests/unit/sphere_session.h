// Calibrated sessions with closed-form truth, photographed without noise: a diffuse sphere, or any surface whose BRDF is known.
#pragma once

#include <functional>

#include "processing/brdf/brdf.h"
#include "processing/calibration/calibrated_session.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {

inline constexpr double kSphereAlbedo = 0.6;

// Latitude-longitude sphere around the origin, outside counter-clockwise.
Mesh sphere_mesh(double radius_m, int rings);

// A view from `eye` towards the origin, 160 x 120 pixels, lit from `light` with intensity 10 in every channel.
View view_of_origin(const std::string& name, const Eigen::Vector3d& eye, const Eigen::Vector3d& light);

// f of the surface at a position, 1/sr.
using SurfaceBrdf = std::function<ChannelValues(const Eigen::Vector3d& x_in_world, const LobeGeometry& geometry)>;

// Photographs of an object of any shape and colour. Renders each view's photograph (one radiance a pixel centre, f * I cos / d^2 with the mesh's own
// normals, 0 in shadow and on the background) into `folder`, without noise, which is stated as 1e-6 all the same.
CalibratedSession photographed_session(Mesh mesh, std::vector<View> views, const SurfaceBrdf& brdf, const TemporaryFolder& folder);
// The same of a diffuse surface of kSphereAlbedo.
CalibratedSession diffuse_session(Mesh mesh, std::vector<View> views, const TemporaryFolder& folder);
// The same of sphere_mesh(0.1, 60).
CalibratedSession sphere_session(std::vector<View> views, const TemporaryFolder& folder);

}  // namespace lumitexel
