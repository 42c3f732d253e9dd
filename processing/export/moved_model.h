// A model put on its mesh in another pose: BRDFs, weights and the texels' normals travel with the surface.
#pragma once

#include <string>

#include "processing/model/model.h"

namespace lumitexel {

// `moved` has the model's vertices and triangles in the model's order; its positions and normals are taken, its texture coordinates not. A texel's
// normal keeps its place in the mesh's tangent frame (tangent_frame.h). Throws BadInput naming `where` if the triangles are others, and if the
// model's mesh has no texture coordinates. The stages before normals know the mesh's normals alone and need no change.
Model on_moved_mesh(Model model, const Mesh& moved, const std::string& where);

}  // namespace lumitexel
