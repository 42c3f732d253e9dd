#include "drivers/aravis/aravis_stream.h"

#include <algorithm>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr int kBuffers = 4;
constexpr guint64 kSlice_us = 20'000;  // how soon a stop is obeyed
// A frame is worth every effort: nothing but the deadline ends asking for its lost packets.
constexpr double kResendsPerPacket = 2.0;
constexpr std::size_t kLeastReceiveBuffer = 4 << 20, kMostReceiveBuffer = 1 << 30;
constexpr guint kFrameRetention_us = 500'000;  // after the last packet, until a frame counts as incomplete

std::string text_of(ArvBufferStatus status) {
  switch (status) {
    case ARV_BUFFER_STATUS_TIMEOUT: return "some of its packets never came";
    case ARV_BUFFER_STATUS_MISSING_PACKETS: return "packets are missing";
    case ARV_BUFFER_STATUS_WRONG_PACKET_ID: return "packets have wrong numbers";
    case ARV_BUFFER_STATUS_SIZE_MISMATCH: return "it does not fit the announced size";
    case ARV_BUFFER_STATUS_ABORTED: return "it was broken off";
    default: return "its status is " + std::to_string(status);
  }
}

}  // namespace

AravisStream::AravisStream(const AravisDevice& device, std::size_t payload_bytes) : device_(device) {
  if (device.is_gige()) {
    // Raw packet sockets, which the library takes where it has the right to: over loopback they delivered other cameras' frames.
    arv_camera_gv_set_stream_options(device.camera(), ARV_GV_STREAM_OPTION_PACKET_SOCKET_DISABLED);
  }
  stream_.reset(device.call("opening the stream", arv_camera_create_stream, static_cast<ArvStreamCallback>(nullptr),
                            static_cast<void*>(nullptr)));
  if (!stream_) throw Protocol(device.name() + ": opening the stream: nothing came back");
  if (ARV_IS_GV_STREAM(stream_.get())) {
    // A receive buffer of the default size loses nearly every large frame; one of just the payload's size, the library's
    // own choice, every small one: a packet takes more room than it has bytes. The kernel cuts it to what it allows.
    const auto buffer_bytes = static_cast<gint>(std::clamp(2 * payload_bytes, kLeastReceiveBuffer, kMostReceiveBuffer));
    g_object_set(stream_.get(), "socket-buffer", ARV_GV_STREAM_SOCKET_BUFFER_FIXED, "socket-buffer-size", buffer_bytes,
                 "packet-resend", ARV_GV_STREAM_PACKET_RESEND_ALWAYS, "packet-request-ratio", kResendsPerPacket,
                 "frame-retention", kFrameRetention_us, nullptr);
  }
  for (int i = 0; i < kBuffers; ++i) arv_stream_push_buffer(stream_.get(), arv_buffer_new(payload_bytes, nullptr));
  device.call("starting acquisition", arv_camera_start_acquisition);
}

void AravisStream::drop_waiting() {
  while (ArvBuffer* buffer = arv_stream_try_pop_buffer(stream_.get())) arv_stream_push_buffer(stream_.get(), buffer);
  missing_before_ = missing_packets();
}

std::uint64_t AravisStream::missing_packets() const {
  return ARV_IS_GV_STREAM(stream_.get()) ? arv_stream_get_info_uint64_by_name(stream_.get(), "n_missing_packets") : 0;
}

void AravisStream::require_whole(ArvBuffer* buffer, const std::string& asked) {
  const ArvBufferStatus status = arv_buffer_get_status(buffer);
  if (status == ARV_BUFFER_STATUS_SUCCESS) return;
  throw Protocol(device_.name() + ": " + asked + ", the frame came incomplete: " + text_of(status) + ", " +
                 std::to_string(missing_packets() - missing_before_) + " packets missing; look at cables and load");
}

AravisStream::Buffer AravisStream::wait(Clock& clock, double deadline_s, const std::string& asked,
                                        std::stop_token stop) {
  while (true) {
    if (stop.stop_requested()) throw Cancelled(device_.name() + ": " + asked + ": cancelled");
    Buffer buffer(arv_stream_timeout_pop_buffer(stream_.get(), kSlice_us), GiveBack{stream_.get()});
    if (buffer) {
      require_whole(buffer.get(), asked);
      return buffer;
    }
    if (device_.control_lost()) throw Disconnected(device_.name() + ": " + asked + ": control of the camera is lost");
    if (clock.now_s() >= deadline_s) throw Timeout(device_.name() + ": " + asked + ": no frame came in time");
  }
}

}  // namespace lumitexel
