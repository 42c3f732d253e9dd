#include <cstdio>
#include <memory>

#include "drivers/error.h"
#include "processing/calibration/calibrated_session.h"
#include "processing/model/fit_model.h"
#include "processing/model/model_file.h"
#include "rig/console/command.h"

namespace lumitexel {
namespace {

constexpr int kMostMaterials = 64;

struct FitSettings {
  std::string session, out, quality = "standard", materials = "4";
  bool separate_lobes = false, plain_projection = false;
};

FitOptions fit_options(const FitSettings& settings) {
  FitOptions options = FitOptions::preset(settings.quality);
  try {
    std::size_t used = 0;
    options.materials = std::stoi(settings.materials, &used);
    if (used != settings.materials.size()) throw std::invalid_argument(settings.materials);
  } catch (const std::exception&) {
    throw BadInput("--materials", "'" + settings.materials + "'", "a whole number from 1 to 64");
  }
  if (options.materials < 1 || options.materials > kMostMaterials) {
    throw BadInput("--materials", settings.materials, "a whole number from 1 to 64");
  }
  options.shared_lobe_shape = !settings.separate_lobes;
  options.plain_projection = settings.plain_projection;
  return options;
}

template <typename... Values>
std::string line(const char* format, Values... values) {
  char buffer[200];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

std::string fit_text(const FitSettings& settings, const FitSummary& summary) {
  std::string text = line("%s: %zu materials, %zu lumitexels, %zu samples (%.1f a lumitexel; %zu lumitexels have none)\n",
                          settings.out.c_str(), summary.texels_by_material.size(), summary.lumitexels, summary.samples,
                          static_cast<double>(summary.samples) / static_cast<double>(summary.lumitexels), summary.starved);
  if (summary.unseen_triangles > 0) text += line("  %zu triangles are seen by no view\n", summary.unseen_triangles);
  text += line("RMS of the samples, 1/sr         %9s %9s %9s\n", "1-RMS", "C-RMS", "P-RMS");
  text += line("  all                            %9.5f %9.5f %9.5f\n", summary.single.rms, summary.cluster.rms,
               summary.projection.rms);
  for (std::size_t c = 0; c < summary.single.by_channel.size(); ++c) {
    text += line("  channel %-2zu                     %9.5f %9.5f %9.5f\n", c, summary.single.by_channel[c],
                 summary.cluster.by_channel[c], summary.projection.by_channel[c]);
  }
  for (std::size_t j = 0; j < summary.single.by_material.size(); ++j) {
    text += line("  material %-2zu %10zu texels  %9.5f %9.5f %9.5f\n", j, summary.texels_by_material[j],
                 summary.single.by_material[j], summary.cluster.by_material[j], summary.projection.by_material[j]);
  }
  text += "Stage            seconds   peak MB\n";
  for (const StageCost& stage : summary.stages) {
    text += line("  %-14s %8.2f %9.0f\n", stage.name.c_str(), stage.seconds, static_cast<double>(stage.peak_bytes) / 1e6);
  }
  return text;
}

CommandResult fit_command(const FitSettings& settings, CommandContext& context) {
  const FitOptions options = fit_options(settings);
  check_model_directory(settings.out);
  const SessionStore store = SessionStore::open(settings.session, OpenMode::ReadOnly);
  StageTimer timer;
  timer.begin("calibration");
  const CalibratedSession session = calibrate_session(store, context.progress);
  const FittedModel fitted = fit_model(session, options, timer, context.progress);
  write_model(settings.out, fitted.model);
  CommandResult result;
  result.json = nlohmann::json::parse(fitted.model.provenance_json);
  result.text = fit_text(settings, fitted.summary);
  return result;
}

}  // namespace

void add_fit_command(CLI::App& app, CommandAction& action) {
  auto settings = std::make_shared<FitSettings>();
  CLI::App* command = app.add_subcommand("fit", "Turn a session into a model: materials, and weights for every texel");
  command->add_option("SESSION", settings->session, "Session to fit: captured or imported")->required();
  command->add_option("--out", settings->out, "Folder of the model; a model that is there is replaced")->required();
  command->add_option("--quality", settings->quality,
                      "draft: materials learnt on 2,000 surface points and fitted to 2,000 each; standard: 10,000 and 5,000; "
                      "reference: all")
      ->capture_default_str();
  command->add_option("--materials", settings->materials, "How many materials to look for, 1 to 64")->capture_default_str();
  command->add_flag("--separate-lobes", settings->separate_lobes,
                    "Give every colour channel a lobe shape of its own, as the paper does, instead of one for all");
  command->add_flag("--plain-projection", settings->plain_projection,
                    "Project texels by least squares without a prior, as the paper does: closer to the photographs of the "
                    "fit, farther from others");
  command->callback([settings, &action] {
    action = [settings](CommandContext& context) { return fit_command(*settings, context); };
  });
}

}  // namespace lumitexel
