// A capture over the protocols whose writing thread hangs right after its first frame has been committed, as on a disk
// that does not answer, while the safety lane has to act.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <thread>

#include "rig/rig_devices.h"
#include "rig/session_store.h"
#include "tests/protocol/session/protocol_rig.h"

namespace lumitexel {

// Milliseconds from trip() until the controller has carried out the last of its lamps off and axes stopped, by its own
// record; infinity: not within two seconds.
struct TripLatency {
  double table_ms = 0.0;  // Modbus TCP: three lamps, one axis
  double arm_ms = 0.0;    // Modbus RTU: two axes, on the line that the devices use, too
};

class FrozenCapture {
 public:
  // Returns once the writer hangs. Meanwhile a thread for each controller reads axes as fast as it is answered.
  FrozenCapture();
  ~FrozenCapture();  // lets the writer go on
  FrozenCapture(const FrozenCapture&) = delete;
  FrozenCapture& operator=(const FrozenCapture&) = delete;

  // Lights all lamps, sets all axes going, trips the lane and waits for its effect; the lane watches again afterwards.
  TripLatency trip();
  bool is_at_rest() const { return rig_.is_at_rest(); }

 private:
  class Hanging;
  void set_going();

  TemporaryFolder folder_;
  ProtocolRig rig_;
  SessionStore session_;
  RigDevices devices_;
  std::unique_ptr<Hanging> progress_;
  bool forward_ = false;
  std::jthread table_reader_, arm_reader_, capture_;
};

}  // namespace lumitexel
