#include <memory>

#include "drivers/error.h"
#include "rig/console/capture_result.h"
#include "rig/console/command.h"
#include "rig/console/input_folder.h"
#include "rig/console/replay_result.h"
#include "rig/console/rig_backend.h"
#include "rig/replay_session.h"
#include "rig/sequencer.h"

namespace lumitexel {
namespace {

CommandResult run(const std::string& directory, CommandContext& context) {
  SessionStore session = session_given("SESSION", directory, OpenMode::ReadWrite);
  if (session.kind() != SessionKind::Captured) {
    throw BadInput(directory, "an imported session has nothing to resume", "a session made by `lumitexel capture`");
  }
  // Before anything is connected: the rig that a replay's documents name is not the one to move.
  if (const auto recording = recording_of(session)) {
    const ReplaySummary summary = play_missing_shots(recording, session, context.progress, context.stop);
    return replay_result(*recording, session, summary);
  }
  const std::string where = session.document("rig.path");
  const RigBackend backend = rig_backend(parse_rig(session.document("rig.toml"), where), where);
  RigDevices devices = backend.connect(context.stop);
  return capture_and_tell(session, devices, context);
}

}  // namespace

void add_resume_command(CLI::App& app, CommandAction& action) {
  const auto directory = std::make_shared<std::string>();
  Command command(app, "resume", "Go on with a capture or replay that was stopped: take the shots it lacks");
  command.add_option("SESSION", *directory, "The session's folder").required();
  command.callback(
      [directory, &action] { action = [directory](CommandContext& context) { return run(*directory, context); }; });
}

}  // namespace lumitexel
