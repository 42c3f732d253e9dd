// The way that a camera's frames come in. Only for the .cpp files of this folder.
#pragma once

#include <cstdint>
#include <memory>
#include <stop_token>
#include <string>

#include "drivers/aravis/aravis_device.h"
#include "drivers/clock.h"

namespace lumitexel {

class AravisStream {
 public:
  // Opens the stream and starts acquisition; frames come when the camera is triggered. The device outlives the stream.
  // Throws Timeout, Disconnected, Protocol.
  AravisStream(const AravisDevice& device, std::size_t payload_bytes);

  // A buffer on loan: it goes back to the stream by itself.
  struct GiveBack {
    ArvStream* stream;
    void operator()(ArvBuffer* buffer) const { arv_stream_push_buffer(stream, buffer); }
  };
  using Buffer = std::unique_ptr<ArvBuffer, GiveBack>;

  // Forgets the frames that have come and nobody asked for.
  void drop_waiting();

  // The next frame, whole. Throws Timeout when none has come by deadline_s on the clock, Protocol for one with packets
  // missing, Disconnected as soon as the camera's control is lost, Cancelled. asked: what was asked for, for messages.
  Buffer wait(Clock& clock, double deadline_s, const std::string& asked, std::stop_token stop);

 private:
  std::uint64_t missing_packets() const;
  void require_whole(ArvBuffer* buffer, const std::string& asked);

  const AravisDevice& device_;
  GHandle<ArvStream> stream_;
  std::uint64_t missing_before_ = 0;
};

}  // namespace lumitexel
