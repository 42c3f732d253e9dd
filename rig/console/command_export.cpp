#include <cmath>
#include <cstdio>
#include <memory>
#include <utility>

#include "processing/export/export_model.h"
#include "processing/render/carry_model.h"
#include "processing/surface/mesh_file.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"

namespace lumitexel {
namespace {

// What stands after the name of the option in --help, a line for each.
constexpr const char* kFormats =
    "Program to write for:\n"
    "gltf: model.gltf, glTF 2.0 with KHR_materials_specular and a normal texture\n"
    "mitsuba: scene.xml for Mitsuba 3, mesh, material, lamp and camera, and reference.exr, our rendering of it\n"
    "materialx: model.mtlx, a gltf_pbr material, with textures and mesh.obj\n"
    "blender: scene.py, run by blender --python scene.py, and reference.exr, our rendering of it\n"
    "maps: every map as EXR and PNG, told apart in maps.json, with mesh.ply";

// What to do with the main file, in the folder of the export.
const char* how_to_open(ExportFormat format) {
  switch (format) {
    case ExportFormat::Gltf: return "any glTF 2.0 viewer opens it";
    case ExportFormat::Mitsuba: return "mitsuba scene.xml";
    case ExportFormat::Materialx: return "MaterialXView --material model.mtlx --mesh mesh.obj";
    case ExportFormat::Blender: return "blender --python scene.py";
    case ExportFormat::Maps: return "tells the maps apart";
  }
  return "";
}

struct ExportSettings {
  std::string model, to, out, mesh;
};

CommandResult export_command(const ExportSettings& settings, CommandContext& context) {
  const ExportFormat format = export_format_from_string(settings.to);
  check_export_directory(settings.out);
  Model model = model_given("MODEL", settings.model);
  if (!settings.mesh.empty()) model = carried_to(std::move(model), read_mesh(settings.mesh), settings.mesh);
  const ConversionLoss loss = export_model(model, format, settings.out, context.progress);
  CommandResult result;
  const bool finite = std::isfinite(loss.error.psnr_db);
  result.json = {{"out", settings.out}, {"to", settings.to},
                 {"loss", {{"views", loss.views}, {"psnr_db", finite ? nlohmann::json(loss.error.psnr_db) : nlohmann::json()},
                           {"relative_rms", loss.error.relative_rms}, {"clipped_rms", loss.error.clipped_rms},
                           {"sqrt_rms", loss.error.sqrt_rms}}}};
  char line[240];
  std::snprintf(line, sizeof line, "%s/%s: %s\nconversion loss over %d renderings: PSNR %.1f dB, relative %.4f, clipped %.4f, sqrt %.4f\n",
                settings.out.c_str(), main_file(format), how_to_open(format), loss.views, loss.error.psnr_db, loss.error.relative_rms, loss.error.clipped_rms,
                loss.error.sqrt_rms);
  result.text = line;
  return result;
}

}  // namespace

void add_export_command(CLI::App& app, CommandAction& action) {
  auto settings = std::make_shared<ExportSettings>();
  Command command(app, "export", "Write a model for other programs, and how much of its look that costs");
  command.add_option("MODEL", settings->model, "Folder of the model").required();
  command.add_option("--to", settings->to, kFormats).required();
  command.add_option("--mesh", settings->mesh,
                     "The model's own mesh.ply with its vertices moved, such as a frame of an animation: the maps go onto it, normals turn with it");
  command.add_option("--out", settings->out, "New or empty folder to write into").required();
  command.callback([settings, &action] {
    action = [settings](CommandContext& context) { return export_command(*settings, context); };
  });
}

}  // namespace lumitexel
