// Sends frames as GigE Vision stream packets, and again what a client has missed.
#pragma once

#include <netinet/in.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <stop_token>
#include <string>
#include <vector>

#include "sim/protocol/gige/gige_camera_options.h"
#include "sim/protocol/gige/udp_socket.h"
#include "sim/seeded_random.h"

namespace lumitexel::gige {

struct StreamFrame {
  std::uint16_t block_id = 0;  // 1, 2, … 65535, 1, …
  std::uint64_t timestamp_ns = 0;
  std::uint32_t pixel_format = 0, width_px = 0, height_px = 0, offset_x_px = 0, offset_y_px = 0;
  bool chunks = false;
  std::uint32_t packet_size = 1500;  // IP and UDP headers included, as the standard counts
  sockaddr_in to{};
  std::vector<std::uint8_t> payload;  // image, then chunks

  std::uint32_t packets() const;  // with leader and trailer
};

// What happens to one frame's packets beyond the camera's own habits.
struct Disturbance {
  double loss = 0.0, reorder = 0.0;
};

// Thread-safe: one thread sends frames, another one answers requests to resend.
class GvspStream {
 public:
  explicit GvspStream(const GigeCameraOptions& options);

  // Returns when the last packet is out; at once when stop is requested.
  void send(std::shared_ptr<const StreamFrame> frame, Disturbance disturbance, std::stop_token stop);
  // Packets first to last of a frame that is still kept; others are ignored.
  void resend(std::uint16_t block_id, std::uint32_t first, std::uint32_t last);
  void forget();  // all frames kept
  // One packet of zeros of this size, as a client asks for to find out what size passes.
  void send_test_packet(std::uint32_t packet_size, const sockaddr_in& to) const;

  std::uint64_t packets_lost() const { return lost_; }
  std::uint64_t packets_resent() const { return resent_; }

 private:
  bool chance(double probability);
  std::vector<std::uint32_t> order_of(const StreamFrame& frame, double loss, double reorder);
  void send_batch(const StreamFrame& frame, const std::uint32_t* packets, std::size_t count, bool again) const;

  GigeCameraOptions options_;
  UdpSocket socket_;
  std::mutex mutex_;
  std::uint64_t draws_ = 0;
  std::deque<std::shared_ptr<const StreamFrame>> kept_;
  std::atomic<std::uint64_t> lost_ = 0, resent_ = 0;
};

}  // namespace lumitexel::gige
