// The control channel of a GigE Vision device: takes commands, answers them, and lets go wrong what a FaultSource says.
// Control privilege belongs to one client at a time, and is lost when that client falls silent.
#pragma once

#include <netinet/in.h>

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "drivers/clock.h"
#include "sim/fault_source.h"
#include "sim/protocol/gige/gige_camera_options.h"
#include "sim/protocol/gige/gige_registers.h"
#include "sim/protocol/gige/udp_socket.h"

namespace lumitexel::gige {

// What the commands act on. Called from the control thread only; must not block.
class GvcpTarget {
 public:
  virtual ~GvcpTarget() = default;
  virtual Status read(std::uint32_t address, std::size_t size, std::vector<std::uint8_t>& bytes) = 0;
  virtual Status write(std::uint32_t address, std::span<const std::uint8_t> bytes) = 0;
  virtual void resend(std::uint16_t block_id, std::uint32_t first, std::uint32_t last) = 0;
  virtual void control_ended() = 0;  // nobody has control any more: acquisition ends
  virtual void reboot() = 0;
  virtual std::uint32_t heartbeat_timeout_ms() const = 0;
};

class GvcpControl {
 public:
  GvcpControl(const GigeCameraOptions& options, std::shared_ptr<FaultSource> faults, GvcpTarget& target);

  void start();
  // From any thread, done soon: the client loses control; the device falls silent and comes back as after power on.
  void withdraw_control() { withdraw_ = true; }
  void reboot() { reboot_ = true; }

 private:
  using Bytes = std::vector<std::uint8_t>;
  struct Client {
    std::uint32_t address = 0;
    std::uint16_t port = 0;
    bool operator==(const Client&) const = default;
  };
  struct LateReply {
    double due_s;
    sockaddr_in to;
    Bytes reply;
  };

  void serve(std::stop_token stop);
  void keep_time();
  void take_from(const UdpSocket& socket);
  void handle(std::span<const std::uint8_t> packet, const sockaddr_in& from);
  void answer(std::uint16_t command, std::uint16_t id, std::span<const std::uint8_t> data, const sockaddr_in& from);
  void answer_wrongly(Fault fault, const Bytes& reply, const sockaddr_in& from);
  Bytes execute(std::uint16_t command, std::uint16_t id, std::span<const std::uint8_t> data, const Client& client);
  Status write(std::uint32_t address, std::span<const std::uint8_t> bytes, const Client& client);
  void end_control();
  void begin_reboot();

  GigeCameraOptions options_;
  std::shared_ptr<FaultSource> faults_;
  GvcpTarget& target_;
  SystemClock clock_;
  UdpSocket socket_;
  std::unique_ptr<UdpSocket> broadcasts_;  // empty where the machine does not let us hear them
  std::atomic<bool> withdraw_ = false, reboot_ = false;
  std::optional<Client> owner_;
  double owner_heard_s_ = 0.0, silent_until_s_ = 0.0;
  Client last_client_;
  std::uint16_t last_id_ = 0;
  Bytes last_reply_;
  std::vector<LateReply> late_;
  std::jthread thread_;
};

}  // namespace lumitexel::gige
