#include "processing/export/export_model.h"

#include "drivers/error.h"
#include "processing/export/blender_scene.h"
#include "processing/export/gltf_file.h"
#include "processing/export/map_files.h"
#include "processing/export/materialx_file.h"
#include "processing/export/mitsuba_scene.h"
#include "rig/pending_directory.h"

namespace lumitexel {

ExportFormat export_format_from_string(const std::string& name) {
  if (name == "gltf") return ExportFormat::Gltf;
  if (name == "maps") return ExportFormat::Maps;
  if (name == "blender") return ExportFormat::Blender;
  if (name == "materialx") return ExportFormat::Materialx;
  if (name == "mitsuba") return ExportFormat::Mitsuba;
  throw BadInput("--to", "'" + name + "'", "gltf, maps, blender, materialx or mitsuba");
}

const char* main_file(ExportFormat format) {
  if (format == ExportFormat::Blender) return "scene.py";
  if (format == ExportFormat::Materialx) return "model.mtlx";
  if (format == ExportFormat::Mitsuba) return "scene.xml";
  return format == ExportFormat::Gltf ? "model.gltf" : "maps.json";
}

namespace {

namespace fs = std::filesystem;

void write_files(const fs::path& directory, ExportFormat format, const Model& model, const RefittedAtlas& atlas, const ExportedMaps& maps, const ConversionLoss& loss) {
  if (format == ExportFormat::Gltf) write_gltf(directory, model.mesh, maps, loss);
  if (format == ExportFormat::Maps) write_map_files(directory, model, atlas, loss);
  if (format == ExportFormat::Blender) write_blender_scene(directory, model, atlas, maps, loss);
  if (format == ExportFormat::Materialx) write_materialx(directory, model.mesh, maps, loss);
  if (format == ExportFormat::Mitsuba) write_mitsuba_scene(directory, model, maps, loss);
}

void check_exportable(const Model& model) {
  if (model.mesh.texcoords.empty()) throw BadInput("model", "a mesh without texture coordinates", "texture coordinates, on which the maps lie; `lumitexel fit` makes them");
  if (model.channels != 1 && model.channels != 3) {
    throw BadInput("model", std::to_string(model.channels) + " channels", "one, or three taken for red, green and blue");
  }
}

}  // namespace

void check_export_directory(const fs::path& directory) {
  if (directory.empty()) throw BadInput("--out", "no name", "a new or empty folder");
  std::error_code unreadable;
  const bool empty = fs::is_directory(directory, unreadable) && fs::is_empty(directory, unreadable);
  if (fs::exists(directory, unreadable) && !empty) throw BadInput("--out", "'" + directory.string() + "' exists", "a new or empty folder");
  try {
    const PendingDirectory probe(directory);
  } catch (const Error& error) {
    throw BadInput("--out", error.what(), "a folder that can be written to");
  }
}

ConversionLoss export_model(const Model& model, ExportFormat format, const fs::path& directory, Progress& progress) {
  check_exportable(model);
  check_export_directory(directory);
  PendingDirectory pending(directory);
  const MaterialForm form = format == ExportFormat::Mitsuba ? MaterialForm::Mitsuba : MaterialForm::Gltf;
  const RefittedAtlas atlas = refit_atlas(model, form, progress);
  const ExportedMaps maps = textures_of(atlas);
  const ConversionLoss loss = conversion_loss(model, maps, progress);
  write_files(pending.path(), format, model, atlas, maps, loss);
  pending.move_into_place();
  return loss;
}

}  // namespace lumitexel
