#include <memory>

#include "rig/console/capture_inputs.h"
#include "rig/console/capture_result.h"
#include "rig/console/command.h"
#include "rig/new_session.h"
#include "rig/sequencer.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

struct CaptureOptions {
  std::string rig, plan, mesh, out;
};

// Everything that can be wrong with the input, and every device that is not there, is found before the session's folder
// is made.
CommandResult run(const CaptureOptions& options, CommandContext& context) {
  SessionStore::require_new_directory(options.out);
  CaptureInputs inputs = read_capture_inputs(options.rig, options.plan, options.mesh);
  RigBackend& backend = inputs.backend;
  SessionContent content{inputs.documents, inputs.shots, {}};
  content.add_files = [&](const fs::path& directory) {
    if (backend.write_truth) backend.write_truth(inputs.plan, directory / "truth");
  };
  RigDevices devices = backend.connect(context.stop);
  SessionStore session = begin_session(options.out, content);
  return capture_and_tell(session, devices, context);
}

}  // namespace

void add_capture_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<CaptureOptions>();
  CLI::App* command = app.add_subcommand("capture", "Photograph what a plan wants into a new session");
  command->add_option("RIG", options->rig, "Rig description, TOML")->required();
  command->add_option("PLAN", options->plan, "Capture plan, TOML")->required();
  command->add_option("--mesh", options->mesh, "The object's coarse mesh (PLY, OBJ), instead of the plan's");
  command->add_option("--out", options->out, "The session's folder: empty or not there yet")->required();
  command->callback(
      [options, &action] { action = [options](CommandContext& context) { return run(*options, context); }; });
}

}  // namespace lumitexel
