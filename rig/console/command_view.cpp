#include <filesystem>
#include <memory>

#include "processing/report/viewer/viewer_page.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

struct ViewSettings {
  std::string model, out;
};

fs::path without_slash(const fs::path& model) {
  const fs::path whole = fs::absolute(model).lexically_normal();
  return whole.has_filename() ? whole : whole.parent_path();
}

CommandResult view_command(const ViewSettings& settings) {
  const Model model = model_given("MODEL", settings.model);
  const fs::path folder = without_slash(settings.model);
  const fs::path out = settings.out.empty() ? fs::path(folder.string() + ".html") : fs::path(settings.out);
  const ViewerPage page = viewer_page(folder.filename().string(), model);
  write_whole_file(out, page.html);
  CommandResult result;
  result.json = {{"out", out.string()}, {"bytes", page.html.size()}, {"bytes_of", page.bytes}, {"texels", page.textured_texels}};
  result.text = out.string() + ": " + std::to_string(page.html.size() / 1000) + " kB, " + std::to_string(page.textured_texels) +
                " texels; open it in a browser\n";
  return result;
}

}  // namespace

void add_view_command(CLI::App& app, CommandAction& action) {
  auto settings = std::make_shared<ViewSettings>();
  CLI::App* command = app.add_subcommand("view", "Interactive page of a model, one file that works offline: turn it, move the light, look into its texels");
  command->add_option("MODEL", settings->model, "Folder of the model")->required();
  command->add_option("--out", settings->out, "HTML file to write; by default beside the model, with its name");
  command->callback([settings, &action] {
    action = [settings](CommandContext&) { return view_command(*settings); };
  });
}

}  // namespace lumitexel
