// A mesh from a file as the simulated object.
#pragma once

#include <Eigen/Core>
#include <filesystem>

#include "processing/surface/mesh.h"

namespace lumitexel {

// Reads the mesh (errors of read_mesh), welds equal vertices (texture coordinates are dropped), turns its up axis to table +z, scales its largest extent to size_m and
// centres its box.
Mesh loaded_object(const std::filesystem::path& path, bool y_is_up, double size_m,
                   const Eigen::Vector3d& centre_in_table);

// Each vertex moved towards its neighbours' mean, again and again, until the vertices are off the given mesh by
// deviation_rms_m or 200 rounds are over.
Mesh smoothed(const Mesh& mesh, double deviation_rms_m);

}  // namespace lumitexel
