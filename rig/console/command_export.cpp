#include <cmath>
#include <cstdio>
#include <memory>

#include "drivers/error.h"
#include "processing/export/export_model.h"
#include "processing/model/model_file.h"
#include "rig/console/command.h"

namespace lumitexel {
namespace {

struct ExportSettings {
  std::string model, to, out;
};

CommandResult export_command(const ExportSettings& settings, CommandContext& context) {
  if (settings.to != "gltf") throw BadInput("--to", "'" + settings.to + "'", "gltf");
  const Model model = read_model(settings.model);
  const ConversionLoss loss = export_gltf(model, settings.out, context.progress);
  CommandResult result;
  const bool finite = std::isfinite(loss.error.psnr_db);
  result.json = {{"out", settings.out}, {"to", settings.to},
                 {"loss", {{"views", loss.views}, {"psnr_db", finite ? nlohmann::json(loss.error.psnr_db) : nlohmann::json()},
                           {"relative_rms", loss.error.relative_rms}, {"clipped_rms", loss.error.clipped_rms},
                           {"sqrt_rms", loss.error.sqrt_rms}}}};
  char line[240];
  std::snprintf(line, sizeof line, "%s/model.gltf\nconversion loss over %d renderings: PSNR %.1f dB, relative %.4f, clipped %.4f, sqrt %.4f\n",
                settings.out.c_str(), loss.views, loss.error.psnr_db, loss.error.relative_rms, loss.error.clipped_rms,
                loss.error.sqrt_rms);
  result.text = line;
  return result;
}

}  // namespace

void add_export_command(CLI::App& app, CommandAction& action) {
  auto settings = std::make_shared<ExportSettings>();
  CLI::App* command = app.add_subcommand("export", "Write a model for other programs, and how much of its look that costs");
  command->add_option("MODEL", settings->model, "Folder of the model")->required();
  command->add_option("--to", settings->to, "gltf: glTF 2.0, metallic-roughness with KHR_materials_specular")->required();
  command->add_option("--out", settings->out, "New or empty folder to write into")->required();
  command->callback([settings, &action] {
    action = [settings](CommandContext& context) { return export_command(*settings, context); };
  });
}

}  // namespace lumitexel
