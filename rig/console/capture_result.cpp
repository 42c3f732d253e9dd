#include "rig/console/capture_result.h"

#include <sstream>

#include "drivers/error.h"
#include "rig/console/duration_text.h"
#include "rig/guarded_run.h"

namespace lumitexel {

CommandResult capture_result(const SessionStore& session, const SequenceSummary& summary) {
  const std::size_t wanted = session.shots().size(), missing = session.missing_shots().size();
  CommandResult result;
  result.json = {{"session", session.directory().string()},
                 {"shots", wanted},
                 {"taken", summary.shots},
                 {"missing", missing},
                 {"rig_seconds", summary.seconds}};
  std::ostringstream text;
  text << session.directory().string() << ": " << wanted - missing << " of " << wanted << " shots, " << summary.shots
       << " of them taken now in " << duration_text(summary.seconds) << " on the rig's clock\n";
  result.text = text.str();
  return result;
}

CommandResult capture_and_tell(SessionStore& session, RigDevices& devices, CommandContext& context) {
  try {
    return capture_result(session, take_missing_shots(session, devices, context.progress, context.stop));
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& error) {
    const std::string text = error.what();
    const std::string paused = text.starts_with(kNotSafe) ? "" : "; lamps are off and axes halted";
    throw Error(text + paused + ". " + std::to_string(session.frames().size()) +
                " frames are kept; mend the cause, then `lumitexel resume " + session.directory().string() + "`");
  }
}

}  // namespace lumitexel
