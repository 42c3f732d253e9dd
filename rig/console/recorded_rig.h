// A rig whose file says backend = "recorded": a session played back.
#pragma once

#include <string>

#include "rig/console/rig_backend.h"

namespace lumitexel {

// [recorded] session of the rig's file, relative to it. Its scanner delivers the recorded mesh; its truth is the
// recording's, where there is one. Shots that failed in the recording and were taken later succeed here at once.
// Throws BadInput, naming `where`, without such a session.
RigBackend recorded_rig(const RigDescription& rig, const std::string& where);

}  // namespace lumitexel
