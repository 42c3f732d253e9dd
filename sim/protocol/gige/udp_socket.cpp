#include "sim/protocol/gige/udp_socket.h"

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "drivers/error.h"

namespace lumitexel::gige {

UdpSocket::UdpSocket(const std::string& address, int port, bool shared)
    : descriptor_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in place{};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  const int yes = 1;
  if (shared) setsockopt(descriptor_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
  if (descriptor_ < 0 || inet_pton(AF_INET, address.c_str(), &place.sin_addr) != 1 ||
      bind(descriptor_, reinterpret_cast<const sockaddr*>(&place), sizeof place) != 0) {
    const std::string cause = std::strerror(errno);
    if (descriptor_ >= 0) close(descriptor_);
    throw Disconnected("simulated camera: cannot listen on " + address + ":" + std::to_string(port) + ": " + cause);
  }
}

UdpSocket::~UdpSocket() { close(descriptor_); }

void UdpSocket::send(std::span<const std::uint8_t> bytes, const sockaddr_in& to) const {
  // A datagram that cannot be sent is a datagram lost: the client's business.
  sendto(descriptor_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to), sizeof to);
}

std::span<const std::uint8_t> UdpSocket::receive(std::span<std::uint8_t> buffer, sockaddr_in& from) const {
  socklen_t length = sizeof from;
  const ssize_t count = recvfrom(descriptor_, buffer.data(), buffer.size(), MSG_DONTWAIT,
                                 reinterpret_cast<sockaddr*>(&from), &length);
  return buffer.first(count > 0 ? static_cast<std::size_t>(count) : 0);
}

}  // namespace lumitexel::gige
