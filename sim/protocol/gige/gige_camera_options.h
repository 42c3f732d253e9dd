// What a simulated GigE Vision camera is like beyond the rig's description of it.
#pragma once

#include <cstdint>
#include <string>

namespace lumitexel {

struct GigeCameraOptions {
  std::string address = "127.0.0.2";  // any of 127.x.y.z; the port is the standard's, 3956
  std::string vendor = "Lumitexel", model = "SimulatedCamera", serial = "0001";
  bool chunks = true;           // each frame tells what it was taken with
  bool timestamp_latch = true;  // a client may ask what time it is on the camera's clock
  int settings_latency_frames = 0;       // settings land so many frames after they are set; the chunks tell the truth
  bool metadata_from_registers = false;  // the chunks tell the registers instead, so they lie while settings are late
  // Of each packet, on its first way as on a resend: the probability to be lost; to be overtaken by a later one.
  double loss = 0.0, reorder = 0.0;
  std::uint64_t seed = 1;
  double pace_MB_per_s = 0.0;  // 0: as fast as the machine sends
  // Executes a command again that arrives again, though the standard says to repeat the answer only.
  bool repeats_commands = false;
  double silence_s = 1.0;     // how long a reboot takes
  double late_reply_s = 0.7;  // more than a client waits
};

}  // namespace lumitexel
