#include "tests/protocol/session/attended_capture.h"

#include <array>
#include <optional>

#include "rig/sequencer.h"

namespace lumitexel {
namespace {

constexpr std::array<const char*, 9> kDevices{"camera",          "controller table", "controller arm",
                                              "turntable",       "light azimuth",    "light elevation",
                                              "point light",     "ring flash",       "backlight"};

// One connection and what can be had with it; a pause, or nothing if the session is complete.
std::optional<SafePause> take_once(ProtocolRig& rig, SessionStore& session, std::stop_token stop) {
  SafePause pause;
  pause.connecting = true;
  std::optional<RigDevices> devices;
  NoProgress nobody;
  try {
    devices = rig.connect(stop);
    pause.connecting = false;
    take_missing_shots(session, *devices, nobody, stop);
    return std::nullopt;
  } catch (const Cancelled&) {
    if (stop.stop_requested()) throw;
    pause.cause = "Cancelled";
  } catch (const Error& error) {
    pause.cause = cause_name(error);
    pause.message = error.what();
  }
  pause.at_rest = rig.is_at_rest();
  pause.told_unsafe = pause.message.find("NOT SAFE") != std::string::npos;
  pause.device = device_in(pause.message);
  return pause;
}

}  // namespace

std::string cause_name(const Error& error) {
  if (dynamic_cast<const Timeout*>(&error)) return "Timeout";
  if (dynamic_cast<const Disconnected*>(&error)) return "Disconnected";
  if (dynamic_cast<const OutOfRange*>(&error)) return "OutOfRange";
  if (dynamic_cast<const Protocol*>(&error)) return "Protocol";
  if (dynamic_cast<const StorageFull*>(&error)) return "StorageFull";
  if (dynamic_cast<const Corrupt*>(&error)) return "Corrupt";
  if (dynamic_cast<const BadInput*>(&error)) return "BadInput";
  if (dynamic_cast<const Cancelled*>(&error)) return "Cancelled";
  return "Error";
}

std::string device_in(const std::string& message) {
  std::string device = "none";
  std::size_t first = std::string::npos;
  for (const char* name : kDevices) {
    const std::size_t at = message.find(name);
    if (at == std::string::npos || (first != std::string::npos && at >= first)) continue;
    first = at;
    device = name;
  }
  return device;
}

AttendedCapture capture_attended(ProtocolRig& rig, SessionStore& session, int most_stalls, std::stop_token stop) {
  SystemClock clock;
  AttendedCapture capture;
  const double start_s = clock.now_s();
  std::size_t missing = session.missing_shots().size();
  for (int stalls = 0; stalls < most_stalls;) {
    ++capture.connections;
    std::optional<SafePause> pause = take_once(rig, session, stop);
    capture.complete = !pause;
    if (!pause) break;
    capture.pauses.push_back(*pause);
    rig.mend();
    const std::size_t still_missing = session.missing_shots().size();
    stalls = still_missing < missing ? 0 : stalls + 1;
    missing = still_missing;
  }
  capture.seconds = clock.now_s() - start_s;
  return capture;
}

}  // namespace lumitexel
