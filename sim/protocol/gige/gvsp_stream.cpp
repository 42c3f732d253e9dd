#include "sim/protocol/gige/gvsp_stream.h"

#include <poll.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "drivers/clock.h"
#include "sim/protocol/gige/register_block.h"

namespace lumitexel::gige {
namespace {

constexpr std::uint32_t kIpAndUdpHeaders = 28, kStreamHeader = 8;
constexpr std::size_t kBatch = 32, kFramesKept = 3, kFurthestOvertaking = 8;
constexpr std::uint8_t kLeader = 1, kTrailer = 2, kPayload = 3;
constexpr std::uint16_t kImage = 0x0001, kWithChunks = 0x4000, kIsResent = 0x0100;

std::uint32_t payload_per_packet(const StreamFrame& frame) {
  return frame.packet_size - kIpAndUdpHeaders - kStreamHeader;
}

// The packet's bytes before the frame's own: its header, and all of a leader or trailer.
std::vector<std::uint8_t> head_of(const StreamFrame& frame, std::uint32_t packet, bool again) {
  std::vector<std::uint8_t> bytes;
  const std::uint32_t last = frame.packets() - 1;
  const std::uint32_t kind = packet == 0 ? kLeader : packet == last ? kTrailer : kPayload;
  append_be16(bytes, again ? kIsResent : std::uint16_t{0});
  append_be16(bytes, frame.block_id);
  append_be32(bytes, kind << 24 | packet);
  if (kind == kPayload) return bytes;
  append_be16(bytes, 0);
  append_be16(bytes, static_cast<std::uint16_t>(frame.chunks ? kImage | kWithChunks : kImage));
  if (kind == kLeader) {
    append_be64(bytes, frame.timestamp_ns);
    for (const std::uint32_t value :
         {frame.pixel_format, frame.width_px, frame.height_px, frame.offset_x_px, frame.offset_y_px, std::uint32_t{0}}) {
      append_be32(bytes, value);
    }
  } else {
    append_be32(bytes, frame.height_px);
  }
  return bytes;
}

}  // namespace

std::uint32_t StreamFrame::packets() const {
  const std::size_t each = payload_per_packet(*this);
  return static_cast<std::uint32_t>((payload.size() + each - 1) / each) + 2;
}

GvspStream::GvspStream(const GigeCameraOptions& options) : options_(options), socket_(options.address, 0, false) {
  const int bytes = 4 << 20;
  setsockopt(socket_.descriptor(), SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes);
}

bool GvspStream::chance(double probability) {
  if (probability <= 0.0) return false;
  const std::lock_guard lock(mutex_);
  return CounterRandom(options_.seed, draws_++).uniform() < probability;
}

// Which packets go out, and in which order.
std::vector<std::uint32_t> GvspStream::order_of(const StreamFrame& frame, double loss, double reorder) {
  std::vector<std::uint32_t> order;
  for (std::uint32_t packet = 0; packet < frame.packets(); ++packet) {
    if (chance(loss)) {
      ++lost_;
    } else {
      order.push_back(packet);
    }
  }
  for (std::size_t i = 0; i + 1 < order.size(); ++i) {
    if (chance(reorder)) std::swap(order[i], order[std::min(i + kFurthestOvertaking, order.size() - 1)]);
  }
  return order;
}

void GvspStream::send_batch(const StreamFrame& frame, const std::uint32_t* packets, std::size_t count,
                            bool again) const {
  std::array<std::vector<std::uint8_t>, kBatch> heads;
  std::array<std::array<iovec, 2>, kBatch> parts;
  std::array<mmsghdr, kBatch> messages{};
  sockaddr_in to = frame.to;
  const std::size_t each = payload_per_packet(frame);
  for (std::size_t i = 0; i < count; ++i) {
    heads[i] = head_of(frame, packets[i], again);
    parts[i][0] = {heads[i].data(), heads[i].size()};
    std::size_t begin = 0, bytes = 0;
    if (packets[i] != 0 && packets[i] != frame.packets() - 1) {
      begin = (packets[i] - 1) * each;
      bytes = std::min(each, frame.payload.size() - begin);
    }
    parts[i][1] = {const_cast<std::uint8_t*>(frame.payload.data()) + begin, bytes};
    messages[i].msg_hdr.msg_name = &to;
    messages[i].msg_hdr.msg_namelen = sizeof to;
    messages[i].msg_hdr.msg_iov = parts[i].data();
    messages[i].msg_hdr.msg_iovlen = 2;
  }
  for (std::size_t sent = 0; sent < count;) {
    const int more = sendmmsg(socket_.descriptor(), messages.data() + sent, static_cast<unsigned>(count - sent), 0);
    sent += more > 0 ? static_cast<std::size_t>(more) : 1;  // one that cannot be sent is one lost
  }
}

void GvspStream::send(std::shared_ptr<const StreamFrame> frame, Disturbance disturbance, std::stop_token stop) {
  {
    const std::lock_guard lock(mutex_);
    kept_.push_back(frame);
    if (kept_.size() > kFramesKept) kept_.pop_front();
  }
  const auto either = [](double a, double b) { return 1.0 - (1.0 - a) * (1.0 - b); };
  const std::vector<std::uint32_t> order = order_of(*frame, either(options_.loss, disturbance.loss),
                                                    either(options_.reorder, disturbance.reorder));
  SystemClock clock;
  const double start_s = clock.now_s();
  for (std::size_t i = 0; i < order.size() && !stop.stop_requested(); i += kBatch) {
    send_batch(*frame, order.data() + i, std::min(kBatch, order.size() - i), false);
    if (options_.pace_MB_per_s <= 0.0) continue;
    const double due_s = start_s + static_cast<double>((i + kBatch) * frame->packet_size) / (1e6 * options_.pace_MB_per_s);
    const int wait_ms = static_cast<int>(std::floor(1e3 * (due_s - clock.now_s())));
    if (wait_ms > 0) poll(nullptr, 0, wait_ms);
  }
}

void GvspStream::resend(std::uint16_t block_id, std::uint32_t first, std::uint32_t last) {
  std::shared_ptr<const StreamFrame> frame;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& kept : kept_) {
      if (kept->block_id == block_id) frame = kept;
    }
  }
  if (!frame) return;
  for (std::uint32_t packet = first; packet <= std::min(last, frame->packets() - 1); ++packet) {
    if (chance(options_.loss)) {
      ++lost_;
      continue;
    }
    send_batch(*frame, &packet, 1, true);
    ++resent_;
  }
}

void GvspStream::forget() {
  const std::lock_guard lock(mutex_);
  kept_.clear();
}

void GvspStream::send_test_packet(std::uint32_t packet_size, const sockaddr_in& to) const {
  socket_.send(std::vector<std::uint8_t>(packet_size - kIpAndUdpHeaders, 0), to);
}

}  // namespace lumitexel::gige
