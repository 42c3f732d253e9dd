// MaterialX 1.38: model.mtlx with a material of the node gltf_pbr, and its textures base.png, specular.png, specular_factor.png,
// roughness.png and, where the texels' normals are not the mesh's, normal.png; mesh.obj beside them has the texture coordinates.
//
// gltf_pbr and not standard_surface: it is the very material that was fitted, so nothing is converted a second time. standard_surface knows no F0 by colour over a diffuse
// base. Renderers put the highlight over the base by their own rule where gltf_material.h has base (1 - largest F).
#pragma once

#include <filesystem>

#include "processing/export/conversion_loss.h"

namespace lumitexel {

// Into an existing folder. The loss stands in the shader's attribute conversion_loss, as JSON. Throws Error if a file cannot be written.
void write_materialx(const std::filesystem::path& directory, const Mesh& mesh, const ExportedMaps& maps, const ConversionLoss& loss);

}  // namespace lumitexel
