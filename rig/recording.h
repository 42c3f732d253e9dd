// A captured session as what happened: one entry for every time that its camera was told to shoot.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "rig/session_store.h"

namespace lumitexel {

// One call of Camera::shoot as it went.
struct RecordedShoot {
  Shot shot;
  std::vector<DiscardRecord> discards;  // attempts that came to nothing, first to last
  std::optional<FrameRecord> frame;     // empty: no frame came in the end, and the run ended with that

  std::int64_t first_utc_ns() const { return discards.empty() ? frame->utc_ns : discards.front().utc_ns; }
};

// What one connection of the camera delivered, in order: a run ends with a shoot that failed, or where the camera's own
// time goes back because it was connected anew.
using RecordedRun = std::vector<RecordedShoot>;

// All of a session's runs. Throws Corrupt for a frame whose shot the session does not have.
std::vector<RecordedRun> recorded_runs(const SessionStore& recording);

// What a replay has yet to play: the shots that it wants, without its own frames and discards.
std::vector<RecordedRun> runs_left(const SessionStore& recording, const SessionStore& replay);

// Every shoot that gave a frame, in order, whatever run it belongs to.
RecordedRun recorded_frames(const SessionStore& recording);

// The frame as the camera delivered it: samples, settings, device time, temperature. Throws Corrupt, naming the file,
// if its bytes are not the ones that were committed.
Frame load_recorded_frame(const SessionStore& recording, const FrameRecord& record);

}  // namespace lumitexel
