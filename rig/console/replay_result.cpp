#include "rig/console/replay_result.h"

#include <algorithm>
#include <sstream>

#include "rig/console/duration_text.h"

namespace lumitexel {
namespace {

void describe_missing(const std::vector<Shot>& missing, std::ostream& text) {
  constexpr std::size_t kShown = 5;
  if (missing.empty()) return;
  text << missing.size() << " shots are missing, as in the recording:";
  for (std::size_t i = 0; i < std::min(kShown, missing.size()); ++i) {
    text << " " << missing[i].id << " (" << to_string(missing[i].kind) << (missing[i].view.empty() ? "" : " of ")
         << missing[i].view << ")";
  }
  text << (missing.size() > kShown ? " …" : "") << "\n";
}

}  // namespace

CommandResult replay_result(const SessionStore& recording, const SessionStore& replay, const ReplaySummary& summary) {
  const std::vector<std::string> left_out = left_out_of(recording, replay);
  const std::vector<Shot> missing = replay.missing_shots();
  const std::size_t frames = replay.frames().size();
  CommandResult result;
  result.json = {{"session", replay.directory().string()},
                 {"frames", frames},
                 {"left_out", left_out},
                 {"missing", missing.size()},
                 {"played", summary.frames},
                 {"discards", summary.discards},
                 {"rig_seconds", summary.seconds}};
  std::ostringstream text;
  text << replay.directory().string() << ": " << frames << " frames, " << summary.frames
       << " of them played now, which took " << duration_text(summary.seconds) << " when they were recorded\n";
  if (summary.discards > 0) text << summary.discards << " attempts failed as they did then\n";
  for (std::size_t i = 0; i < left_out.size(); ++i) text << (i == 0 ? "left out: " : ", ") << left_out[i];
  text << (left_out.empty() ? "" : "\n");
  describe_missing(missing, text);
  result.text = text.str();
  return result;
}

}  // namespace lumitexel
