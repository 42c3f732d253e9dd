// A model in a form that other programs read.
#pragma once

#include <filesystem>
#include <string>

#include "processing/export/conversion_loss.h"

namespace lumitexel {

// Writes into `directory`, which is made; throws BadInput if it exists and is not empty, if the model's mesh has no texture coordinates or
// if it has neither one nor three channels. Returns what the conversion loses.
ConversionLoss export_gltf(const Model& model, const std::filesystem::path& directory, Progress& progress);

}  // namespace lumitexel
