// Wavefront OBJ: v, vt, vn and f (with negative indices and polygons); everything else is skipped.
#pragma once

#include <string>
#include <string_view>

#include "processing/surface/mesh_check.h"

namespace lumitexel {

// A vertex of the result is one triple v/vt/vn that a face uses, in the order of first use. Texture coordinates are
// kept only if every corner has them. Throws BadInput naming `where` and the line for anything unreadable or an index
// out of range; see check_mesh for the rest.
ParsedMesh parse_obj(std::string_view bytes, const std::string& where);

}  // namespace lumitexel
