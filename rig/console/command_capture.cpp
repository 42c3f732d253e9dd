#include <memory>

#include "drivers/error.h"
#include "processing/surface/mesh_file.h"
#include "rig/console/capture_result.h"
#include "rig/console/command.h"
#include "rig/whole_file.h"
#include "rig/console/rig_backend.h"
#include "rig/new_session.h"
#include "rig/schedule.h"
#include "rig/sequencer.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;

struct CaptureOptions {
  std::string rig, plan, out;
};

Mesh coarse_mesh(const CapturePlan& plan, const std::string& plan_file, const RigBackend& backend) {
  if (plan.mesh != "scan") return read_mesh(fs::path(plan_file).parent_path() / plan.mesh);
  if (!backend.scan) throw BadInput(plan_file + ": mesh", "'scan'", "a mesh file: this rig has no scanner");
  return backend.scan();
}

// Everything that can be wrong with the input is found before the session's folder is made.
CommandResult run(const CaptureOptions& options, CommandContext& context) {
  SessionContent content;
  content.documents["rig.toml"] = read_whole_file(options.rig);
  content.documents["plan.toml"] = read_whole_file(options.plan);
  const RigDescription rig = parse_rig(content.documents["rig.toml"], options.rig);
  const CapturePlan plan = parse_plan(content.documents["plan.toml"], options.plan);
  content.shots = schedule_shots(plan, rig, options.plan);
  SessionStore::require_new_directory(options.out);
  RigBackend backend = connect_rig(rig, options.rig);
  content.documents["mesh.ply"] = encode_ply(coarse_mesh(plan, options.plan, backend));
  content.add_files = [&](const fs::path& directory) {
    if (backend.write_truth) backend.write_truth(plan, directory / "truth");
  };
  SessionStore session = begin_session(options.out, content);
  return capture_result(session, take_missing_shots(session, backend.devices, context.progress, context.stop));
}

}  // namespace

void add_capture_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<CaptureOptions>();
  CLI::App* command = app.add_subcommand("capture", "Photograph what a plan wants into a new session");
  command->add_option("RIG", options->rig, "Rig description, TOML")->required();
  command->add_option("PLAN", options->plan, "Capture plan, TOML")->required();
  command->add_option("--out", options->out, "The session's folder: empty or not there yet")->required();
  command->callback(
      [options, &action] { action = [options](CommandContext& context) { return run(*options, context); }; });
}

}  // namespace lumitexel
