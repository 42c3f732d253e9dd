// What `capture` and `resume` say when they are done.
#pragma once

#include "rig/console/command.h"
#include "rig/sequencer.h"
#include "rig/session_store.h"

namespace lumitexel {

CommandResult capture_result(const SessionStore& session, const SequenceSummary& summary);

}  // namespace lumitexel
