// One fault at one operation of a short session over the protocols: what became of it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sim/fault_source.h"
#include "tests/protocol/session/protocol_rig.h"

namespace lumitexel {

struct SingleFault {
  CameraKind camera = CameraKind::Gige;
  std::string device;  // "camera" or "controller", as FaultSource names them
  Fault fault = Fault::None;
  std::uint64_t at = 1;  // of the device's operations, connecting included
  std::string text() const;
};

struct SingleFaultOutcome {
  SingleFault what;
  bool happened = false;
  int pauses = 0;
  double seconds = 0.0;     // all of it
  std::string objection;    // empty if the session ended as it must; else what went wrong
};

// Operations of both devices in a short session without faults.
struct SessionOperations {
  std::uint64_t camera = 0, controller = 0;
};
SessionOperations count_operations(CameraKind camera);

// The faults that can strike each device.
std::vector<Fault> faults_of(CameraKind camera, const std::string& device);

// Every fault at every `step`-th operation of each device.
std::vector<SingleFault> fault_matrix(CameraKind camera, const SessionOperations& operations, std::uint64_t step);

// Ends as it must: complete and correct; or, any number of times, in an error by cause that names a device, with all
// lamps dark and all axes standing, after which mending and connecting again completes it.
SingleFaultOutcome suffer(const SingleFault& what);

// All of them, so many at a time; the outcomes in the same order.
std::vector<SingleFaultOutcome> suffer_all(const std::vector<SingleFault>& all, int threads);

}  // namespace lumitexel
