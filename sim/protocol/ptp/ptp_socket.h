// TCP on IPv4 for the simulated camera: a listening socket and its connections. Every wait ends when stop is requested
// or the socket is shut down from another thread.
#pragma once

#include <cstdint>
#include <span>
#include <stop_token>
#include <string>

namespace lumitexel::ptp {

class Socket {
 public:
  Socket() = default;
  explicit Socket(int descriptor) : descriptor_(descriptor) {}
  ~Socket();
  Socket(Socket&& other) noexcept : descriptor_(other.descriptor_) { other.descriptor_ = -1; }
  Socket& operator=(Socket&& other) noexcept;
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  // False if the connection ended first.
  bool read(std::span<std::uint8_t> into, std::stop_token stop) const;
  bool write(std::span<const std::uint8_t> data, std::stop_token stop) const;
  // Ends the connection for both sides; the descriptor stays taken until the Socket goes.
  void shut_down() const;

  int descriptor() const { return descriptor_; }

 private:
  int descriptor_ = -1;
};

// port 0: the kernel chooses one. Throws BadInput if the address is none or the port is taken.
Socket listening_socket(const std::string& address, int port);
int port_of(const Socket& socket);
// The next connection; without descriptor if stop was requested.
Socket accepted(const Socket& listener, std::stop_token stop);

}  // namespace lumitexel::ptp
