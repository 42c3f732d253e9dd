// A capture with somebody at the rig: after every safe pause what is broken is mended, the devices are connected again
// and the session goes on, as a lab would do it.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "drivers/error.h"
#include "rig/session_store.h"
#include "tests/protocol/session/protocol_rig.h"

namespace lumitexel {

struct SafePause {
  bool connecting = false;  // while connecting, not during shots
  std::string device;       // named by the message: "camera", "controller table", "turntable", "point light", …; or "none"
  std::string cause;        // "Timeout", "Disconnected", …; "Error" for a trip of the safety lane
  std::string message;
  bool at_rest = true;      // lamps dark and axes standing when it was reported
  bool told_unsafe = false;  // the message says that a controller has not acknowledged that
};

struct AttendedCapture {
  std::vector<SafePause> pauses;
  int connections = 0;
  double seconds = 0.0;
  bool complete = false;  // false: most_stalls pauses in a row without a new frame
};

// Name of the error's type: "Timeout", …
std::string cause_name(const Error& error);
// Which of a protocol rig's devices the message names, the first one; "none" if none.
std::string device_in(const std::string& message);

// Everything that is missing of the session, taken over the rig's protocols. Throws what is no device's fault.
AttendedCapture capture_attended(ProtocolRig& rig, SessionStore& session, int most_stalls = 20,
                                 std::stop_token stop = {});

}  // namespace lumitexel
