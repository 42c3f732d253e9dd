#include "drivers/aravis/gige_presence.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cstdint>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr std::uint16_t kControlPort = 3956;
constexpr int kTries = 4, kWait_ms = 250;
// "Who are you?", acknowledge required, no data, request 0xffff.
constexpr std::array<std::uint8_t, 8> kDiscovery{0x42, 0x01, 0x00, 0x02, 0x00, 0x00, 0xff, 0xff};

class Probe {
 public:
  Probe() : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {}
  ~Probe() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  Probe(const Probe&) = delete;
  Probe& operator=(const Probe&) = delete;

  // Routing decides which of our addresses it is; nothing is sent.
  bool face(const std::string& address) const {
    sockaddr_in device{};
    device.sin_family = AF_INET;
    device.sin_port = htons(kControlPort);
    return inet_pton(AF_INET, address.c_str(), &device.sin_addr) == 1 &&
           connect(descriptor_, reinterpret_cast<const sockaddr*>(&device), sizeof device) == 0;
  }
  bool is_answered() const {
    for (int i = 0; i < kTries; ++i) {
      pollfd answer{descriptor_, POLLIN, 0};
      std::uint8_t byte;
      if (send(descriptor_, kDiscovery.data(), kDiscovery.size(), 0) < 0) {
        poll(nullptr, 0, kWait_ms);  // refused a moment ago: the camera may just be coming up
      } else if (poll(&answer, 1, kWait_ms) > 0 && recv(descriptor_, &byte, 1, MSG_DONTWAIT) > 0) {
        return true;
      }
    }
    return false;
  }
  std::string own_address() const {
    sockaddr_in own{};
    socklen_t length = sizeof own;
    std::array<char, INET_ADDRSTRLEN> text{};
    getsockname(descriptor_, reinterpret_cast<sockaddr*>(&own), &length);
    return inet_ntop(AF_INET, &own.sin_addr, text.data(), text.size());
  }

 private:
  int descriptor_;
};

}  // namespace

bool is_ip_address(const std::string& text) {
  in_addr parsed;
  return inet_pton(AF_INET, text.c_str(), &parsed) == 1;
}

std::string own_address_facing(const std::string& device_address, const std::string& camera) {
  const Probe probe;
  if (!probe.face(device_address)) throw Disconnected(camera + ": connecting: no network leads to " + device_address);
  if (!probe.is_answered()) {
    throw Disconnected(camera + ": connecting: asked it to identify itself, nothing came back; is it on and cabled?");
  }
  return probe.own_address();
}

}  // namespace lumitexel
