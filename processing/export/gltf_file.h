// glTF 2.0: model.gltf, model.bin, base.png, specular.png, metallic_roughness.png.
#pragma once

#include <filesystem>

#include "processing/export/conversion_loss.h"

namespace lumitexel {

// Lengths in metres, axes as the model's. The loss stands in asset.extras. Throws Error if a file cannot be written.
void write_gltf(const std::filesystem::path& directory, const Mesh& mesh, const ExportedMaps& maps, const ConversionLoss& loss);

}  // namespace lumitexel
