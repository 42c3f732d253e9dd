// What the simulated camera answers to each PTP operation. No sockets, no threads of its own; not thread-safe.
#pragma once

#include <cstdint>

#include "sim/protocol/ptp/camera_properties.h"
#include "sim/protocol/ptp/memory_card.h"
#include "sim/protocol/ptp/packet.h"
#include "sim/protocol/ptp/shutter.h"

namespace lumitexel::ptp {

class Operations {
 public:
  Operations(const ShutterIdentity& identity, CameraProperties& properties, MemoryCard& card, Shutter& shutter)
      : identity_(identity), properties_(properties), card_(card), shutter_(shutter) {}

  // A connection has ended, and its session with it.
  void close_session() { open_ = false; }
  // session: the connection's number, kept for the events of what is started by it. fault: of a capture.
  Reply answer(const Request& request, std::uint64_t session, Fault fault);

 private:
  Reply in_session(const Request& request, std::uint64_t session, Fault fault);
  Reply device_info() const;
  Reply storage_info() const;
  Reply object_info(std::uint32_t handle) const;
  Reply object(std::uint32_t handle) const;
  Reply capture(const Request& request, std::uint64_t session, Fault fault);

  ShutterIdentity identity_;
  CameraProperties& properties_;
  MemoryCard& card_;
  Shutter& shutter_;
  bool open_ = false;
};

}  // namespace lumitexel::ptp
