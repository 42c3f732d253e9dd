#include "sim/protocol/gige/gvcp_control.h"

#include <poll.h>

#include <array>

#include "drivers/error.h"
#include "sim/protocol/gige/register_block.h"

namespace lumitexel::gige {
namespace {

constexpr int kPort = 3956;
constexpr int kPollTimeout_ms = 10;
constexpr std::uint8_t kCommandKey = 0x42;
constexpr std::size_t kHeader = 8, kLargestCommand = 1024;
constexpr std::uint16_t kDiscovery = 0x0002, kPacketResend = 0x0040, kReadRegister = 0x0080, kWriteRegister = 0x0082,
                        kReadMemory = 0x0084, kWriteMemory = 0x0086;

std::vector<std::uint8_t> reply_of(std::uint16_t command, std::uint16_t id, Status status,
                                   const std::vector<std::uint8_t>& data) {
  std::vector<std::uint8_t> reply;
  append_be16(reply, static_cast<std::uint16_t>(status));
  append_be16(reply, static_cast<std::uint16_t>(command + 1));
  append_be16(reply, static_cast<std::uint16_t>(data.size()));
  append_be16(reply, id);
  reply.insert(reply.end(), data.begin(), data.end());
  return reply;
}

std::string operation_of(std::uint16_t command, std::span<const std::uint8_t> data) {
  if (command == kReadRegister) return "read_register";
  if (command == kReadMemory) return "read_memory";
  if (command == kWriteMemory) return "write_memory";
  const std::uint32_t address = data.size() >= 4 ? be32(data) : 0;
  if (address == kControlPrivilege) return "accept control";
  return address == kTriggerSoftware ? "trigger" : "write_register";
}

}  // namespace

GvcpControl::GvcpControl(const GigeCameraOptions& options, std::shared_ptr<FaultSource> faults, GvcpTarget& target)
    : options_(options), faults_(std::move(faults)), target_(target), socket_(options.address, kPort, false) {
  try {
    broadcasts_ = std::make_unique<UdpSocket>("255.255.255.255", kPort, true);
  } catch (const Disconnected&) {
    // Found by its address only.
  }
}

void GvcpControl::start() {
  thread_ = std::jthread([this](std::stop_token stop) { serve(stop); });
}

void GvcpControl::serve(std::stop_token stop) {
  while (!stop.stop_requested()) {
    std::array<pollfd, 2> sockets{pollfd{socket_.descriptor(), POLLIN, 0},
                                  pollfd{broadcasts_ ? broadcasts_->descriptor() : -1, POLLIN, 0}};
    poll(sockets.data(), sockets.size(), kPollTimeout_ms);
    keep_time();
    if (sockets[0].revents & POLLIN) take_from(socket_);
    if (sockets[1].revents & POLLIN) take_from(*broadcasts_);
  }
}

void GvcpControl::keep_time() {
  const double now_s = clock_.now_s();
  if (withdraw_.exchange(false)) end_control();
  if (reboot_.exchange(false)) begin_reboot();
  if (owner_ && now_s - owner_heard_s_ > 1e-3 * target_.heartbeat_timeout_ms()) end_control();
  std::erase_if(late_, [&](const LateReply& late) {
    if (late.due_s > now_s) return false;
    socket_.send(late.reply, late.to);
    return true;
  });
}

void GvcpControl::end_control() {
  owner_.reset();
  target_.control_ended();
}

void GvcpControl::begin_reboot() {
  owner_.reset();
  last_reply_.clear();
  late_.clear();
  target_.reboot();
  silent_until_s_ = clock_.now_s() + options_.silence_s;
}

void GvcpControl::take_from(const UdpSocket& socket) {
  std::array<std::uint8_t, kLargestCommand> buffer;
  sockaddr_in from{};
  const auto packet = socket.receive(buffer, from);
  if (packet.size() < kHeader || packet[0] != kCommandKey || clock_.now_s() < silent_until_s_) return;
  if (packet.size() < kHeader + be16(packet.subspan(4))) return;
  handle(packet, from);
}

void GvcpControl::handle(std::span<const std::uint8_t> packet, const sockaddr_in& from) {
  const std::uint16_t command = be16(packet.subspan(2)), id = be16(packet.subspan(6));
  const auto data = packet.subspan(kHeader, be16(packet.subspan(4)));
  if (owner_ && *owner_ == Client{from.sin_addr.s_addr, from.sin_port}) owner_heard_s_ = clock_.now_s();
  if (command == kDiscovery) {
    Bytes found;
    target_.read(0, kDiscoveryEnd, found);
    socket_.send(reply_of(command, id, Status::Success, found), from);
  } else if (command == kPacketResend) {
    if (data.size() >= 12) target_.resend(be16(data.subspan(2)), be32(data.subspan(4)), be32(data.subspan(8)));
  } else {
    answer(command, id, data, from);
  }
}

void GvcpControl::answer(std::uint16_t command, std::uint16_t id, std::span<const std::uint8_t> data,
                         const sockaddr_in& from) {
  const Client client{from.sin_addr.s_addr, from.sin_port};
  if (!options_.repeats_commands && !last_reply_.empty() && client == last_client_ && id == last_id_) {
    socket_.send(last_reply_, from);
    return;
  }
  const Fault fault = faults_->next("camera", operation_of(command, data),
                                    {Fault::Mute, Fault::LateReply, Fault::Exception, Fault::Garbage, Fault::HalfReply,
                                     Fault::Disconnect});
  if (fault == Fault::Mute && faults_->detail() < 0.5) return;  // the command itself was lost
  if (fault == Fault::Disconnect) {
    if (faults_->detail() >= 0.5) return begin_reboot();
    end_control();
  }
  const Bytes reply =
      fault == Fault::Exception ? reply_of(command, id, Status::Busy, {}) : execute(command, id, data, client);
  last_client_ = client;
  last_id_ = id;
  last_reply_ = reply;
  answer_wrongly(fault, reply, from);
}

void GvcpControl::answer_wrongly(Fault fault, const Bytes& reply, const sockaddr_in& from) {
  Bytes sent = reply;
  switch (fault) {
    case Fault::Mute: return;
    case Fault::LateReply: late_.push_back({clock_.now_s() + options_.late_reply_s, from, reply}); return;
    case Fault::HalfReply: sent.resize(reply.size() / 2); break;
    case Fault::Garbage:
      for (std::uint8_t& byte : sent) byte = static_cast<std::uint8_t>(256.0 * faults_->detail());
      break;
    default: break;
  }
  socket_.send(sent, from);
}

GvcpControl::Bytes GvcpControl::execute(std::uint16_t command, std::uint16_t id, std::span<const std::uint8_t> data,
                                        const Client& client) {
  Bytes out;
  Status status = data.size() >= 4 ? Status::Success : Status::InvalidParameter;
  if (status != Status::Success) return reply_of(command, id, status, out);
  if (command == kReadRegister) {
    for (std::size_t i = 0; i + 4 <= data.size() && status == Status::Success; i += 4) {
      status = target_.read(be32(data.subspan(i)), 4, out);
    }
  } else if (command == kReadMemory && data.size() >= 8) {
    append_be32(out, be32(data));
    status = target_.read(be32(data), be16(data.subspan(6)), out);
  } else if (command == kWriteRegister) {
    std::uint32_t done = 0;
    for (std::size_t i = 0; i + 8 <= data.size() && status == Status::Success; i += 8) {
      status = write(be32(data.subspan(i)), data.subspan(i + 4, 4), client);
      if (status == Status::Success) ++done;
    }
    append_be32(out, done);
  } else if (command == kWriteMemory) {
    status = write(be32(data), data.subspan(4), client);
    append_be32(out, static_cast<std::uint32_t>(data.size() - 4));
  } else {
    status = Status::NotImplemented;
  }
  return reply_of(command, id, status, out);
}

Status GvcpControl::write(std::uint32_t address, std::span<const std::uint8_t> bytes, const Client& client) {
  if (address == kControlPrivilege && bytes.size() == 4) {
    if (owner_ && *owner_ != client) return Status::AccessDenied;
    const bool takes = be32(bytes) != 0;
    if (!takes && owner_) end_control();
    if (takes) {
      owner_ = client;
      owner_heard_s_ = clock_.now_s();
    }
    return target_.write(address, bytes);
  }
  return owner_ && *owner_ == client ? target_.write(address, bytes) : Status::AccessDenied;
}

}  // namespace lumitexel::gige
