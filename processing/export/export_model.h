// A model in a form that other programs read.
#pragma once

#include <filesystem>
#include <string>

#include "processing/export/conversion_loss.h"

namespace lumitexel {

enum class ExportFormat {
  Gltf,  // gltf_file.h
  Maps,  // map_files.h
  Blender,  // blender_scene.h
  Materialx,  // materialx_file.h
  Mitsuba,  // mitsuba_scene.h
};
ExportFormat export_format_from_string(const std::string& name);  // "gltf", "maps", "blender", "materialx", "mitsuba"; throws BadInput
// The file that another program opens first.
const char* main_file(ExportFormat format);

// What export_model would refuse of a folder, to be asked before the long work: throws BadInput if it exists and is not empty, or cannot be made.
void check_export_directory(const std::filesystem::path& directory);

// Writes a folder beside `directory`, which becomes it once all is there; nothing is left of one that was not finished. Throws BadInput as check_export_directory, if
// the model's mesh has no texture coordinates or if it has neither one nor three channels; Error if it cannot be written. Returns what the conversion loses.
ConversionLoss export_model(const Model& model, ExportFormat format, const std::filesystem::path& directory, Progress& progress);

}  // namespace lumitexel
