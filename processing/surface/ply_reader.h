// PLY, ascii and binary little endian: elements "vertex" (x, y, z; nx, ny, nz; s, t or u, v or texture_u, texture_v) and "face" (the list
// vertex_indices or vertex_index, and where vertices have no texture coordinates the list texcoord, two numbers a corner). Other elements
// and properties are skipped.
#pragma once

#include <string>
#include <string_view>

#include "processing/surface/mesh_check.h"

namespace lumitexel {

// Throws BadInput naming `where` and the header's line, or the element, for anything that cannot be read. Only the form
// is checked here: see check_mesh for the rest.
ParsedMesh parse_ply(std::string_view bytes, const std::string& where);

}  // namespace lumitexel
