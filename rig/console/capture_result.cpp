#include "rig/console/capture_result.h"

#include <sstream>

#include "rig/console/duration_text.h"

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

}  // namespace lumitexel
