// What the sequencer knows to stand before the camera, and how it gets changed: by the rig's stage hand, or by an operator
// between one run and the next.
//
//   operator:  a shot needs another prop ▸ "asked for" goes into the journal, the run ends in a safe pause
//              the next run takes the operator's word that the prop asked for last stands there now, and says so
//
// A run takes the word for one prop, so that no shot is taken of a stage that nobody can have changed. A session that never
// asked has the object on the table.
#pragma once

#include <stop_token>

#include "rig/rig_devices.h"
#include "rig/session_store.h"

namespace lumitexel {

class Stage {
 public:
  Stage(RigDevices& devices, SessionStore& session);

  // Returns once `prop` stands there. Throws what the stage hand throws; without one, Error that tells the operator what
  // to do.
  void show(const Prop& prop, std::stop_token stop);

 private:
  RigDevices& devices_;
  SessionStore& session_;
  std::optional<Prop> placed_;  // empty: unknown
};

}  // namespace lumitexel
