// A UDP socket that is closed with its owner.
#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <span>
#include <string>

namespace lumitexel::gige {

class UdpSocket {
 public:
  // port 0: the kernel chooses. shared: others on this machine may bind the same. Throws Disconnected naming the address.
  UdpSocket(const std::string& address, int port, bool shared);
  ~UdpSocket();
  UdpSocket(const UdpSocket&) = delete;
  UdpSocket& operator=(const UdpSocket&) = delete;

  int descriptor() const { return descriptor_; }
  void send(std::span<const std::uint8_t> bytes, const sockaddr_in& to) const;
  // What has come, cut to the buffer's size; empty if nothing has. Does not wait.
  std::span<const std::uint8_t> receive(std::span<std::uint8_t> buffer, sockaddr_in& from) const;

 private:
  int descriptor_;
};

}  // namespace lumitexel::gige
