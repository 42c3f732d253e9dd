// A model as a directory: model.json, basis.json, cluster.exr, weights_0.exr (four planes a file), normal.exr,
// uncertainty.exr, samples.exr, mesh.ply. Any common EXR reader opens the maps.
#pragma once

#include <filesystem>

#include "processing/model/model.h"

namespace lumitexel {

// The folder's own path, absolute: "out/bird/" and "out/bird" are the same, and a sibling's name must not land inside it.
std::filesystem::path without_trailing_slash(const std::filesystem::path& directory);

// Throws BadInput if `directory` exists and is neither empty nor a model, or cannot be written: what write_model would refuse, to be asked
// before the long work.
void check_model_directory(const std::filesystem::path& directory);

// Writes a whole new directory beside `directory` and renames it into place; an existing model is replaced.
// Throws BadInput if `directory` exists and is not a model, Error if it cannot be written.
void write_model(const std::filesystem::path& directory, const Model& model);
// Throws BadInput naming the file and field if anything is missing, of the wrong shape, or not finite.
Model read_model(const std::filesystem::path& directory);

}  // namespace lumitexel
