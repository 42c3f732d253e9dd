#include "sim/protocol/ptp/packet.h"

#include <algorithm>
#include <span>

#include "sim/protocol/ptp/dataset.h"

namespace lumitexel::ptp {
namespace {

constexpr std::uint32_t kHead = 8;
constexpr std::uint32_t kLongest = 1u << 20;  // clients send texts and numbers only

void append(std::vector<std::uint8_t>& to, const std::vector<std::uint8_t>& bytes) {
  to.insert(to.end(), bytes.begin(), bytes.end());
}

}  // namespace

std::optional<Packet> read_packet(const Socket& socket, std::stop_token stop) {
  std::array<std::uint8_t, kHead> head;
  if (!socket.read(head, stop)) return {};
  DatasetReader reader(head);
  const std::uint32_t length = reader.u32();
  Packet packet{static_cast<PacketType>(reader.u32()), {}};
  if (length < kHead || length > kLongest) return {};
  packet.body.resize(length - kHead);
  if (!socket.read(packet.body, stop)) return {};
  return packet;
}

std::vector<std::uint8_t> encoded(const Packet& packet) {
  DatasetWriter writer;
  writer.u32(kHead + packet.body.size()).u32(static_cast<std::uint32_t>(packet.type)).bytes(packet.body);
  return writer.take();
}

std::optional<Request> read_request(const Packet& command, const Socket& socket, std::stop_token stop) {
  DatasetReader reader(command.body);
  const bool data_follow = reader.u32() == 2;
  Request request;
  request.operation = static_cast<Operation>(reader.u16());
  request.transaction = reader.u32();
  for (std::uint32_t& parameter : request.parameters) {
    if (reader.left() >= 4) parameter = reader.u32();
  }
  for (bool done = !data_follow; !done;) {
    const std::optional<Packet> packet = read_packet(socket, stop);
    if (!packet) return {};
    done = packet->type == PacketType::EndData;
    if (!done && packet->type != PacketType::Data) continue;
    const std::size_t head = std::min<std::size_t>(4, packet->body.size());  // the transaction's number again
    request.data.insert(request.data.end(), packet->body.begin() + static_cast<std::ptrdiff_t>(head),
                        packet->body.end());
  }
  return request;
}

EncodedReply encoded(const Reply& reply, std::uint32_t transaction) {
  EncodedReply out;
  if (reply.data) {
    DatasetWriter start;
    start.u32(transaction).u64(reply.data->size());
    out.before = encoded(Packet{PacketType::StartData, start.take()});
    DatasetWriter end;  // all data in one packet, its head here
    end.u32(kHead + 4 + reply.data->size()).u32(static_cast<std::uint32_t>(PacketType::EndData)).u32(transaction);
    append(out.before, end.data());
    out.bulk = reply.data;
  }
  DatasetWriter response;
  response.u16(static_cast<std::uint16_t>(reply.code)).u32(transaction);
  for (const std::uint32_t parameter : reply.parameters) response.u32(parameter);
  out.after = encoded(Packet{PacketType::CommandResponse, response.take()});
  return out;
}

bool write_reply(const Socket& socket, const EncodedReply& reply, std::size_t max_bytes, std::stop_token stop) {
  const auto part = [&](std::span<const std::uint8_t> bytes) {
    const std::size_t count = std::min(bytes.size(), max_bytes);
    max_bytes -= count;
    return socket.write(bytes.first(count), stop);
  };
  return part(reply.before) && (!reply.bulk || part(*reply.bulk)) && part(reply.after);
}

}  // namespace lumitexel::ptp
