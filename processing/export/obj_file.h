// Wavefront OBJ: positions, normals and texture coordinates, v up.
#pragma once

#include <filesystem>

#include "processing/surface/mesh.h"

namespace lumitexel {

// The mesh needs normals and texture coordinates. Throws Error if the file cannot be written.
void write_obj(const std::filesystem::path& path, const Mesh& mesh);

}  // namespace lumitexel
