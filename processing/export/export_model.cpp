#include "processing/export/export_model.h"

#include "drivers/error.h"
#include "processing/export/blender_scene.h"
#include "processing/export/gltf_file.h"
#include "processing/export/map_files.h"
#include "processing/export/materialx_file.h"
#include "processing/export/mitsuba_scene.h"

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

// Before the work, which takes a while.
void make_empty_folder(const fs::path& directory) {
  if (fs::exists(directory) && !(fs::is_directory(directory) && fs::is_empty(directory))) {
    throw BadInput("--out", "'" + directory.string() + "' exists", "a new or empty folder");
  }
  std::error_code failed;
  fs::create_directories(directory, failed);
  if (failed) throw BadInput("--out", "'" + directory.string() + "' cannot be made (" + failed.message() + ")", "a folder that can be written to");
}

void check_exportable(const Model& model) {
  if (model.mesh.texcoords.empty()) throw BadInput("model", "a mesh without texture coordinates", "texture coordinates, on which the maps lie; `lumitexel fit` makes them");
  if (model.channels != 1 && model.channels != 3) {
    throw BadInput("model", std::to_string(model.channels) + " channels", "one, or three taken for red, green and blue");
  }
}

}  // namespace

ConversionLoss export_model(const Model& model, ExportFormat format, const fs::path& directory, Progress& progress) {
  check_exportable(model);
  make_empty_folder(directory);
  const MaterialForm form = format == ExportFormat::Mitsuba ? MaterialForm::Mitsuba : MaterialForm::Gltf;
  const RefittedAtlas atlas = refit_atlas(model, form, progress);
  const ExportedMaps maps = textures_of(atlas);
  const ConversionLoss loss = conversion_loss(model, maps, progress);
  if (format == ExportFormat::Gltf) write_gltf(directory, model.mesh, maps, loss);
  if (format == ExportFormat::Maps) write_map_files(directory, model, atlas, loss);
  if (format == ExportFormat::Blender) write_blender_scene(directory, model, atlas, maps, loss);
  if (format == ExportFormat::Materialx) write_materialx(directory, model.mesh, maps, loss);
  if (format == ExportFormat::Mitsuba) write_mitsuba_scene(directory, model, maps, loss);
  return loss;
}

}  // namespace lumitexel
