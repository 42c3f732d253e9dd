// What `capture` and `resume` say when they are done.
#pragma once

#include "rig/console/command.h"
#include "rig/sequencer.h"
#include "rig/session_store.h"

namespace lumitexel {

CommandResult capture_result(const SessionStore& session, const SequenceSummary& summary);

// Takes the missing shots. A fault's text gets what an operator has to know next: that the rig is paused, and how to go on.
CommandResult capture_and_tell(SessionStore& session, RigDevices& devices, CommandContext& context);

}  // namespace lumitexel
