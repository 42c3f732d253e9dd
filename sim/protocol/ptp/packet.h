// PTP/IP packets: a length, a type, a body.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <stop_token>
#include <vector>

#include "sim/protocol/ptp/ptp_codes.h"
#include "sim/protocol/ptp/ptp_socket.h"

namespace lumitexel::ptp {

struct Packet {
  PacketType type{};
  std::vector<std::uint8_t> body;
};

// Empty if the connection ended, or a packet has an impossible length.
std::optional<Packet> read_packet(const Socket& socket, std::stop_token stop);
std::vector<std::uint8_t> encoded(const Packet& packet);

// What a client asks for: a command packet, and the data packets that follow it if it sends any.
struct Request {
  Operation operation{};
  std::uint32_t transaction = 0;
  std::array<std::uint32_t, 5> parameters{};
  std::vector<std::uint8_t> data;
};

// command: a CommandRequest packet; its data are read from the socket. Empty if the connection ended. Throws Protocol.
std::optional<Request> read_request(const Packet& command, const Socket& socket, std::stop_token stop);

using SharedBytes = std::shared_ptr<const std::vector<std::uint8_t>>;

struct Reply {
  Response code = Response::Ok;
  std::vector<std::uint32_t> parameters;
  SharedBytes data;  // the data phase; null: none
};

// In the order in which they go out. Pictures are large: `bulk` is not copied.
struct EncodedReply {
  std::vector<std::uint8_t> before;
  SharedBytes bulk;
  std::vector<std::uint8_t> after;
  std::size_t size() const { return before.size() + (bulk ? bulk->size() : 0) + after.size(); }
};

EncodedReply encoded(const Reply& reply, std::uint32_t transaction);
// Sends the first max_bytes of it. False if the connection ended.
bool write_reply(const Socket& socket, const EncodedReply& reply, std::size_t max_bytes, std::stop_token stop);

}  // namespace lumitexel::ptp
