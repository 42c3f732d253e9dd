#include <memory>

#include "processing/calibration/import/import_session.h"
#include "rig/console/command.h"

namespace lumitexel {

void add_import_command(CLI::App& app, CommandAction& action) {
  struct Options {
    ImportSources sources;
    std::filesystem::path masks, out;
  };
  auto options = std::make_shared<Options>();
  Command command(app, "import", "Make a session of photographs taken elsewhere");
  command.add_option("--colmap", options->sources.colmap, "Directory of COLMAP's cameras.txt and images.txt")
      .required();
  command.add_option("--images", options->sources.images, "Directory of the photographs: EXR, or PNG or TIFF")
      .required();
  command.add_option("--lights", options->sources.lights, "CSV of the light of each photograph").required();
  command.add_option("--mesh", options->sources.mesh, "The object's surface, PLY or OBJ, in metres").required();
  command.add_option("--masks", options->masks, "Directory of masks, 8-bit PNG, 255 where the object is");
  command.add_option(
      "--response", options->sources.response,
      "How 8- and 16-bit code values map to light: linear, srgb or a CSV file of code,linear from 0,… to 1,…");
  command.add_option("--out", options->out, "The session to make").required();
  command.callback([options, &action] {
    action = [options](CommandContext& context) {
      if (!options->masks.empty()) options->sources.masks = options->masks;
      const ImportSummary summary = import_session(options->sources, options->out, context.progress, context.stop);
      CommandResult result;
      result.json = {{"views", summary.views},
                     {"heldout", summary.heldout},
                     {"channels", summary.channels},
                     {"session", options->out.string()}};
      result.text = options->out.string() + ": " + std::to_string(summary.views) + " views, " +
                    std::to_string(summary.heldout) + " of them held out, " +
                    (summary.channels == 1 ? "grayscale" : "colour") + "\n";
      return result;
    };
  });
}

}  // namespace lumitexel
