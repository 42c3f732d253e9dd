#include <memory>

#include "drivers/error.h"
#include "processing/fit/mip_levels.h"
#include "processing/fit/provenance.h"
#include "processing/model/model_file.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"
#include "rig/console/output_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

struct MipSettings {
  std::string model, session;
  int levels = 4;
};

void require_fitted_session(const Model& model, const CalibratedSession& session, const MipSettings& settings) {
  const std::string fitted_to = fitted_session_key(model);
  if (session.key == fitted_to) return;
  throw BadInput("--session",
                 settings.session + " is not the session that " + settings.model + " was fitted to, or has changed since (it is " + session.key + ", the model's was " +
                     (fitted_to.empty() ? "not noted" : fitted_to) + ")",
                 "the model's own session as it was then; `lumitexel fit` anew, or no --session, which averages what the model has");
}

// With a session, the photographs that levels are fitted to.
struct Refit {
  CalibratedSession session;
  LumitexelSet fine;
};

std::optional<Refit> refit_of(const Model& model, const MipSettings& settings, Progress& progress) {
  if (settings.session.empty()) return std::nullopt;
  Refit refit{calibrate_session(session_given("--session", settings.session), progress), {}};
  require_fitted_session(model, refit.session, settings);
  refit.fine = texel_lumitexels(model, refit.session, progress);
  return refit;
}

CommandResult mip_command(const MipSettings& settings, CommandContext& context) {
  const Model model = model_given("MODEL", settings.model);
  PendingDirectory pending = pending_output("MODEL", levels_directory(settings.model));
  const std::optional<Refit> refit = refit_of(model, settings, context.progress);
  CommandResult result;
  const char* way = refit ? "refitted" : "averaged";
  result.json = {{"way", way}, {"levels", nlohmann::json::array()}};
  context.progress.begin("levels", settings.levels, "levels");
  for (int level = 1; level <= settings.levels; ++level) {
    Model coarser = averaged_level(model, level);
    if (refit) coarser = refitted_level(model, coarser, refit->fine, refit->session, level);
    const fs::path folder = level_directory(settings.model, level);
    write_model(pending.path() / folder.filename(), coarser);
    result.json["levels"].push_back({{"level", level}, {"width", coarser.width}, {"height", coarser.height}, {"folder", folder.string()}});
    result.text += folder.string() + ": " + std::to_string(coarser.width) + " x " + std::to_string(coarser.height) + " texels, " + way + "\n";
    context.progress.update(level);
  }
  pending.replace_target();
  return result;
}

}  // namespace

void add_mip_command(CLI::App& app, CommandAction& action) {
  auto settings = std::make_shared<MipSettings>();
  Command command(app, "mip", "Coarser levels of a model's maps, for pictures from afar; render --level shows them");
  command.add_option("MODEL", settings->model, "Folder of the model; its levels are written to MODEL/levels and replace those there once all are made").required();
  command.add_option("--session", settings->session,
                     "The session that the model was fitted to: levels are fitted anew to its photographs, normals too, instead of averaged");
  command.add_option("--levels", settings->levels, "How many, each half as fine as the one before; an atlas of many small patches shrinks by less, as each keeps a border").range(1, kMostLevels).capture_default_str();
  command.callback([settings, &action] {
    action = [settings](CommandContext& context) { return mip_command(*settings, context); };
  });
}

}  // namespace lumitexel
