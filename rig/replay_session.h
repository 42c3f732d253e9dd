// A captured session played back, through the same sequencer, into a new session.
#pragma once

#include <filesystem>
#include <memory>
#include <stop_token>

#include "rig/progress.h"
#include "rig/session_store.h"
#include "rig/view_selection.h"

namespace lumitexel {

// The views of a captured session's plan, in its order.
std::vector<SelectableView> planned_views(const SessionStore& recording);

// A session like the recording, without frames yet: its documents and truth/, its plan and shots less what was left
// out. Shots keep their ids. Throws BadInput for an imported session or a directory in use, Error or StorageFull.
SessionStore begin_replay(const SessionStore& recording, const ViewSelection& selection,
                          const std::filesystem::path& directory);

// The recording that a session made by begin_replay plays; empty for other sessions. Throws BadInput, naming both, if
// it has been moved or its content has changed since.
std::shared_ptr<const SessionStore> recording_of(const SessionStore& replay);

// What the recording has and the replay left out: views by name, kinds of shots as "kind=dark".
std::vector<std::string> left_out_of(const SessionStore& recording, const SessionStore& replay);

struct ReplaySummary {
  std::int64_t frames = 0;    // played now
  std::int64_t discards = 0;  // attempts that failed in the recording, and now again
  double seconds = 0;         // on the recording's clock
};

// Plays what the replay still lacks, run by run as it was recorded: a run that a fault ended ends here, too, and the
// next one goes on. Shots that the recording lacks stay missing. With everything played the replay's frames, times,
// settings, positions and discards are the recording's. Throws Corrupt for a recorded frame that is damaged, Cancelled
// on stop, what the store throws.
ReplaySummary play_missing_shots(const std::shared_ptr<const SessionStore>& recording, SessionStore& replay,
                                 Progress& progress, std::stop_token stop);

}  // namespace lumitexel
