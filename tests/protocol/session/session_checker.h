// Whether each frame of a session is the frame of its shot, by what its pixels say (sim/state_strip.h). Reads the session
// and nothing else.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "rig/session_store.h"

namespace lumitexel {

enum class Wrong {
  Lost,        // a shot without a frame
  Duplicated,  // an exposure that is in two frames, or a shot with two
  Unreadable,  // the file is not what was stored, or its pixels carry no strip
  Settings,    // taken with others than the shot's
  Position,    // of any axis
  Lamps,
  Key,         // the frame of another shot
  Record,      // the journal says otherwise than the pixels
};
const char* to_string(Wrong wrong);

struct WrongFrame {
  Wrong how = Wrong::Lost;
  std::int64_t shot_id = 0;
  std::string text;
};

struct SessionCheck {
  std::int64_t shots = 0, frames = 0;
  std::vector<WrongFrame> wrong;

  int count(Wrong how) const;
  int lost() const { return count(Wrong::Lost); }
  int duplicated() const { return count(Wrong::Duplicated); }
  int mislabelled() const;  // frames with anything else wrong, each once
  std::string text() const;  // the first few, a line each
};

// The session's camera has the state strip on, and its shots are quantised.
SessionCheck check_session(const SessionStore& session);

}  // namespace lumitexel
