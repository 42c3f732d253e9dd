#include "sim/protocol/ptp/ptp_socket.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "drivers/error.h"

namespace lumitexel::ptp {
namespace {

constexpr int kSlice_ms = 20;  // how long a stop request may go unnoticed

bool wait_for(int descriptor, short what, std::stop_token stop) {
  while (!stop.stop_requested()) {
    pollfd entry{descriptor, what, 0};
    if (poll(&entry, 1, kSlice_ms) > 0) return true;
  }
  return false;
}

bool try_again() { return errno == EAGAIN || errno == EWOULDBLOCK || errno == EINTR; }

}  // namespace

Socket::~Socket() {
  if (descriptor_ >= 0) close(descriptor_);
}

Socket& Socket::operator=(Socket&& other) noexcept {
  std::swap(descriptor_, other.descriptor_);
  return *this;
}

bool Socket::read(std::span<std::uint8_t> into, std::stop_token stop) const {
  while (!into.empty()) {
    if (!wait_for(descriptor_, POLLIN, stop)) return false;
    const ssize_t count = recv(descriptor_, into.data(), into.size(), MSG_DONTWAIT);
    if (count > 0) {
      into = into.subspan(static_cast<std::size_t>(count));
    } else if (count == 0 || !try_again()) {
      return false;
    }
  }
  return true;
}

bool Socket::write(std::span<const std::uint8_t> data, std::stop_token stop) const {
  while (!data.empty()) {
    if (!wait_for(descriptor_, POLLOUT, stop)) return false;
    const ssize_t count = send(descriptor_, data.data(), data.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    if (count >= 0) {
      data = data.subspan(static_cast<std::size_t>(count));
    } else if (!try_again()) {
      return false;
    }
  }
  return true;
}

void Socket::shut_down() const {
  if (descriptor_ >= 0) shutdown(descriptor_, SHUT_RDWR);
}

Socket listening_socket(const std::string& address, int port) {
  const std::string where = "simulated PTP camera at " + address + ":" + std::to_string(port);
  sockaddr_in name{};
  name.sin_family = AF_INET;
  name.sin_port = htons(static_cast<std::uint16_t>(port));
  if (inet_pton(AF_INET, address.c_str(), &name.sin_addr) != 1) throw BadInput(where, "no address", "1.2.3.4");
  Socket socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  const int on = 1;
  setsockopt(socket.descriptor(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  if (bind(socket.descriptor(), reinterpret_cast<const sockaddr*>(&name), sizeof name) != 0 ||
      listen(socket.descriptor(), 8) != 0) {
    throw BadInput(where, std::strerror(errno), "a local address and a free port");
  }
  return socket;
}

int port_of(const Socket& socket) {
  sockaddr_in name{};
  socklen_t size = sizeof name;
  getsockname(socket.descriptor(), reinterpret_cast<sockaddr*>(&name), &size);
  return ntohs(name.sin_port);
}

Socket accepted(const Socket& listener, std::stop_token stop) {
  while (wait_for(listener.descriptor(), POLLIN, stop)) {
    Socket connection(accept4(listener.descriptor(), nullptr, nullptr, SOCK_CLOEXEC));
    if (connection.descriptor() < 0) continue;
    const int on = 1;
    setsockopt(connection.descriptor(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    return connection;
  }
  return {};
}

}  // namespace lumitexel::ptp
