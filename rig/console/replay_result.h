// What `replay`, and `resume` of a replay, say when they are done.
#pragma once

#include "rig/console/command.h"
#include "rig/replay_session.h"

namespace lumitexel {

// {"session", "frames": in it now, "left_out": [view or "kind=KIND"], "missing": shots that the recording lacks,
//  "played": frames now, "discards": attempts that failed as they did then, "rig_seconds"}
CommandResult replay_result(const SessionStore& recording, const SessionStore& replay, const ReplaySummary& summary);

}  // namespace lumitexel
