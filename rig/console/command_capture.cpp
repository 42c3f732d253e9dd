#include <memory>

#include "drivers/error.h"
#include "processing/calibration/lens/lens_file.h"
#include "rig/console/capture_inputs.h"
#include "rig/console/capture_result.h"
#include "rig/console/command.h"
#include "rig/new_session.h"
#include "rig/sequencer.h"
#include "rig/whole_file.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

struct CaptureOptions {
  std::string rig, plan, mesh, lens, out;
};

// A lens calibrated before travels with the session; one of another camera is refused at once.
std::string lens_document(const std::string& path, const CameraDescription& camera) {
  const std::string mismatch = lens_mismatch(read_lens_file(path), "", camera.limits);
  if (!mismatch.empty()) throw BadInput("--lens " + path, mismatch, "a lens calibration of this rig's camera");
  return read_whole_file(path);
}

// Everything that can be wrong with the input, and every device that is not there, is found before the session's folder
// is made.
CommandResult run(const CaptureOptions& options, CommandContext& context) {
  SessionStore::require_new_directory(options.out);
  CaptureInputs inputs = read_capture_inputs(options.rig, options.plan, options.mesh);
  if (!options.lens.empty()) inputs.documents["lens.json"] = lens_document(options.lens, inputs.rig.camera);
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
  Command command(app, "capture", "Photograph what a plan wants into a new session");
  command.add_option("RIG", options->rig, "Rig description, TOML").required();
  command.add_option("PLAN", options->plan, "Capture plan, TOML").required();
  command.add_option("--mesh", options->mesh, "The object's coarse mesh (PLY, OBJ), instead of the plan's");
  command.add_option("--lens", options->lens,
                     "A lens calibration (calibrate --lens-out); board shots in the plan then check whether it still holds");
  command.add_option("--out", options->out, "The session's folder: empty or not there yet").required();
  command.callback(
      [options, &action] { action = [options](CommandContext& context) { return run(*options, context); }; });
}

}  // namespace lumitexel
