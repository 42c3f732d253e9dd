#include "processing/export/export_model.h"

#include "drivers/error.h"
#include "processing/export/gltf_file.h"

namespace lumitexel {

ConversionLoss export_gltf(const Model& model, const std::filesystem::path& directory, Progress& progress) {
  namespace fs = std::filesystem;
  if (fs::exists(directory) && !(fs::is_directory(directory) && fs::is_empty(directory))) {
    throw BadInput("--out", "'" + directory.string() + "' exists", "a new or empty folder");
  }
  if (model.mesh.texcoords.empty()) throw BadInput("model", "a mesh without texture coordinates", "them");
  if (model.channels != 1 && model.channels != 3) {
    throw BadInput("model", std::to_string(model.channels) + " channels", "one, or three taken for red, green and blue");
  }
  const ExportedMaps maps = refit_maps(model, progress);
  const ConversionLoss loss = conversion_loss(model, maps, progress);
  fs::create_directories(directory);
  write_gltf(directory, model.mesh, maps, loss);
  return loss;
}

}  // namespace lumitexel
