#include <memory>

#include "drivers/error.h"
#include "rig/console/capture_result.h"
#include "rig/console/command.h"
#include "rig/console/rig_backend.h"
#include "rig/sequencer.h"

namespace lumitexel {
namespace {

CommandResult run(const std::string& directory, CommandContext& context) {
  SessionStore session = SessionStore::open(directory, OpenMode::ReadWrite);
  if (session.kind() != SessionKind::Captured) {
    throw BadInput(directory, "an imported session has nothing to resume", "a session made by `lumitexel capture`");
  }
  const std::string where = session.document("rig.path");
  RigBackend backend = connect_rig(parse_rig(session.document("rig.toml"), where), where);
  return capture_result(session, take_missing_shots(session, backend.devices, context.progress, context.stop));
}

}  // namespace

void add_resume_command(CLI::App& app, CommandAction& action) {
  const auto directory = std::make_shared<std::string>();
  CLI::App* command = app.add_subcommand("resume", "Go on with a capture that was stopped: take the shots it lacks");
  command->add_option("SESSION", *directory, "The session's folder")->required();
  command->callback(
      [directory, &action] { action = [directory](CommandContext& context) { return run(*directory, context); }; });
}

}  // namespace lumitexel
