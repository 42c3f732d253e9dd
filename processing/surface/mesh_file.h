// PLY (ascii and binary little endian) and OBJ.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "processing/surface/mesh.h"

namespace lumitexel {

// Reads and checks: throws BadInput naming `where` and the line, vertex or face for anything unreadable, for an index out of
// range, a NaN or infinite coordinate, a zero-area triangle, an edge with more than two triangles (non-manifold), or an
// empty mesh. Polygons are split into fans. Missing normals are computed. format: ".ply" or ".obj".
Mesh parse_mesh(std::string_view bytes, const std::string& format, const std::string& where);
Mesh read_mesh(const std::filesystem::path& path);

// Binary little-endian PLY, with double positions so that nothing is lost, normals, and texture coordinates (s, t) if the mesh has them.
std::string encode_ply(const Mesh& mesh);
void write_ply(const std::filesystem::path& path, const Mesh& mesh);  // throws Error

}  // namespace lumitexel
