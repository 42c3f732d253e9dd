#include <memory>

#include "drivers/error.h"
#include "processing/fit/mip_levels.h"
#include "processing/model/model_file.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"

namespace lumitexel {
namespace {

struct MipSettings {
  std::string model, session;
  int levels = 4;
};

CommandResult mip_command(const MipSettings& settings, CommandContext& context) {
  const Model model = model_given("MODEL", settings.model);
  std::optional<CalibratedSession> session;
  LumitexelSet fine;
  if (!settings.session.empty()) {
    session = calibrate_session(session_given("--session", settings.session), context.progress);
    if (session->mesh.triangles.size() != model.mesh.triangles.size() || session->channels != model.channels) {
      throw BadInput("--session", settings.session + " has another mesh than the model", "the session that the model was fitted to");
    }
    fine = texel_lumitexels(model, *session, context.progress);
  }
  CommandResult result;
  const char* way = session ? "refitted" : "averaged";
  result.json = {{"way", way}, {"levels", nlohmann::json::array()}};
  std::filesystem::remove_all(std::filesystem::path(settings.model) / "levels");  // of an earlier run, perhaps more of them
  context.progress.begin("levels", settings.levels, "levels");
  for (int level = 1; level <= settings.levels; ++level) {
    Model coarser = averaged_level(model, level);
    if (session) coarser = refitted_level(model, coarser, fine, *session, level);
    const std::filesystem::path folder = level_directory(settings.model, level);
    write_model(folder, coarser);
    result.json["levels"].push_back({{"level", level}, {"width", coarser.width}, {"height", coarser.height}, {"folder", folder.string()}});
    result.text += folder.string() + ": " + std::to_string(coarser.width) + " x " + std::to_string(coarser.height) + " texels, " + way + "\n";
    context.progress.update(level);
  }
  return result;
}

}  // namespace

void add_mip_command(CLI::App& app, CommandAction& action) {
  auto settings = std::make_shared<MipSettings>();
  Command command(app, "mip", "Coarser levels of a model's maps, for pictures from afar; render --level shows them");
  command.add_option("MODEL", settings->model, "Folder of the model; its levels are written to MODEL/levels, replacing those there").required();
  command.add_option("--session", settings->session,
                     "The session that the model was fitted to: levels are fitted anew to its photographs, normals too, instead of averaged");
  command.add_option("--levels", settings->levels, "How many, each half as fine as the one before; an atlas of many small patches shrinks by less, as each keeps a border").range(1, kMostLevels).capture_default_str();
  command.callback([settings, &action] {
    action = [settings](CommandContext& context) { return mip_command(*settings, context); };
  });
}

}  // namespace lumitexel
