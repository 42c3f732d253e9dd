#include <filesystem>
#include <memory>
#include <optional>

#include "processing/model/model_file.h"
#include "processing/report/viewer/viewer_page.h"
#include "processing/report/viewer/viewer_sky.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"
#include "rig/console/output_file.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

struct ViewSettings {
  std::string model, session, environment, out;
};

ViewerPage page_of(const std::string& title, const Model& model, const ViewSettings& settings, CommandContext& context) {
  std::optional<Image> sky;
  if (!settings.environment.empty()) sky = read_sky(settings.environment, model.channels);
  const Image* const given_sky = sky ? &*sky : nullptr;
  if (settings.session.empty()) return viewer_page(title, model, nullptr, given_sky);
  const CalibratedSession session = calibrate_session(session_given("--session", settings.session), context.progress);
  const LumitexelRecords records = lumitexel_records(model, session, context.progress);
  const ViewerSamples samples{session, records};
  return viewer_page(title, model, &samples, given_sky);
}

std::string samples_text(std::size_t every) {
  if (every == 0) return "";
  return every == 1 ? ", with all samples" : ", with the samples of one of " + std::to_string(every) + " lumitexels";
}

CommandResult view_command(const ViewSettings& settings, CommandContext& context) {
  require_writable_folder("--out", settings.out);
  const Model model = model_given("MODEL", settings.model);
  const fs::path folder = without_trailing_slash(settings.model);
  const fs::path out = settings.out.empty() ? fs::path(folder.string() + ".html") : fs::path(settings.out);
  require_writable_folder("--out", out);  // the usual place, too
  const ViewerPage page = page_of(folder.filename().string(), model, settings, context);
  write_whole_file(out, page.html);
  CommandResult result;
  result.json = {{"out", out.string()}, {"bytes", page.html.size()}, {"bytes_of", page.bytes}, {"texels", page.textured_texels}, {"every", page.every}};
  result.text = out.string() + ": " + std::to_string(page.html.size() / 1000) + " kB, " + std::to_string(page.textured_texels) +
                " texels" + samples_text(page.every) + "; open it in a browser\n";
  return result;
}

}  // namespace

void add_view_command(CLI::App& app, CommandAction& action) {
  auto settings = std::make_shared<ViewSettings>();
  Command command(app, "view", "Interactive page of a model, one file that works offline: turn it, move the light, look into its texels");
  command.add_option("MODEL", settings->model, "Folder of the model").required();
  command.add_option("--session", settings->session,
                     "Session that the model was fitted to: a click on the object then shows the samples of its photographs (at most 16 MB of them)");
  command.add_option("--environment", settings->environment,
                     "EXR of all directions, latitude against longitude, for the page's surroundings (reduced to 256 pixels across); by default a room with two soft boxes");
  command.add_option("--out", settings->out, "HTML file to write; by default beside the model, with its name");
  command.callback([settings, &action] {
    action = [settings](CommandContext& context) { return view_command(*settings, context); };
  });
}

}  // namespace lumitexel
