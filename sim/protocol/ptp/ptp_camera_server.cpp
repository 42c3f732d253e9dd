#include "sim/protocol/ptp/ptp_camera_server.h"

#include <limits>

#include "drivers/clock.h"
#include "drivers/error.h"
#include "sim/protocol/ptp/dataset.h"

namespace lumitexel {

using ptp::DatasetWriter;
using ptp::EncodedReply;
using ptp::Packet;
using ptp::PacketType;

namespace {

const std::vector<Fault> kConnectionFaults{Fault::Mute,    Fault::LateReply, Fault::Exception,
                                           Fault::Garbage, Fault::HalfReply, Fault::Disconnect};
const std::vector<Fault> kEventFaults{Fault::Mute, Fault::LateReply, Fault::Garbage, Fault::HalfReply,
                                      Fault::Disconnect};

std::string operation_name(ptp::Operation operation) {
  if (operation == ptp::Operation::InitiateCapture) return "capture";
  return operation == ptp::Operation::GetObject ? "transfer" : "operation";
}

EncodedReply whole(std::vector<std::uint8_t> bytes) { return {std::move(bytes), nullptr, {}}; }

}  // namespace

PtpCameraServer::PtpCameraServer(std::shared_ptr<SimulatedBench> bench, std::shared_ptr<FaultSource> faults,
                                 const PtpCameraOptions& options)
    : faults_(std::move(faults)),
      options_(options),
      properties_(bench->camera().limits, options.iso_choices, options.iso_at_0_db),
      identity_{options.make, options.model, options.serial},
      command_listener_(ptp::listening_socket(options.address, options.command_port)),
      shutter_(bench, card_, identity_,
               [this](const ptp::Release& release, std::uint32_t handle, std::stop_token stop) {
                 tell(release, ptp::EventCode::ObjectAdded, handle, stop);
                 tell(release, ptp::EventCode::CaptureComplete, 0, stop);
               }),
      operations_(identity_, properties_, card_, shutter_) {
  if (options.event_port != options.command_port) {
    event_listener_ = ptp::listening_socket(options.address, options.event_port);
    acceptors_.emplace_back([this](std::stop_token stop) { accept_from(event_listener_, stop); });
  }
  acceptors_.emplace_back([this](std::stop_token stop) { accept_from(command_listener_, stop); });
}

PtpCameraServer::~PtpCameraServer() {
  acceptors_.clear();
  for (Connection& connection : connections_) connection.thread.request_stop();
  for (Connection& connection : connections_) connection.thread.join();
}

std::string PtpCameraServer::gphoto_port() const {
  const int commands = ptp::port_of(command_listener_);
  const int events = event_listener_.descriptor() < 0 ? commands : ptp::port_of(event_listener_);
  return "ptpip:" + options_.address + ":" + std::to_string(commands) + ":" + std::to_string(events);
}

void PtpCameraServer::plug(bool plugged_in) {
  const std::lock_guard lock(mutex_);
  plugged_in_ = plugged_in;
  if (!plugged_in) hang_up();
}

// Under the lock. The connections' own threads see their ends and leave.
void PtpCameraServer::hang_up() {
  for (Connection& connection : connections_) connection.socket.shut_down();
}

void PtpCameraServer::accept_from(const ptp::Socket& listener, std::stop_token stop) {
  while (!stop.stop_requested()) {
    ptp::Socket socket = ptp::accepted(listener, stop);
    if (socket.descriptor() < 0) return;
    const std::lock_guard lock(mutex_);
    connections_.remove_if([](const Connection& connection) { return connection.done.load(); });
    if (!plugged_in_) continue;
    Connection& connection = connections_.emplace_back();
    connection.socket = std::move(socket);
    connection.thread = std::jthread([this, &connection](std::stop_token own_stop) { serve(connection, own_stop); });
  }
}

void PtpCameraServer::serve(Connection& connection, std::stop_token stop) {
  try {
    const auto first = ptp::read_packet(connection.socket, stop);
    if (first && first->type == PacketType::InitEventRequest) serve_events(connection, stop);
    if (first && first->type == PacketType::InitCommandRequest) serve_commands(connection, stop);
  } catch (const Error&) {
    // A data set that no client sends, or the end of this server: either way the connection is over.
  }
  connection.socket.shut_down();
  leave(connection);
}

void PtpCameraServer::leave(Connection& connection) {
  {
    const std::lock_guard lock(mutex_);
    if (events_ == &connection) events_ = nullptr;
    if (commands_ == &connection) commands_ = nullptr;
  }
  connection.done = true;
}

void PtpCameraServer::serve_events(Connection& connection, std::stop_token stop) {
  {
    const std::lock_guard lock(mutex_);
    events_ = &connection;
    connection.socket.write(ptp::encoded(Packet{PacketType::InitEventAck, {}}), stop);
  }
  while (const auto packet = ptp::read_packet(connection.socket, stop)) {
    const std::lock_guard lock(mutex_);
    if (packet->type == PacketType::Ping) {
      connection.socket.write(ptp::encoded(Packet{PacketType::Pong, {}}), stop);
    }
  }
}

void PtpCameraServer::serve_commands(Connection& connection, std::stop_token stop) {
  std::uint64_t session = 0;
  {
    // A client that comes again is the one that was here: what is left of the earlier connection goes.
    const std::scoped_lock lock(operations_mutex_, mutex_);
    if (commands_ != nullptr) commands_->socket.shut_down();
    commands_ = &connection;
    session = ++session_;
    wedged_ = false;
    operations_.close_session();
  }
  if (!greet(connection, stop)) return;
  while (const auto packet = ptp::read_packet(connection.socket, stop)) {
    if (packet->type != PacketType::CommandRequest) continue;
    if (!answer(connection, *packet, session, stop)) return;
  }
}

bool PtpCameraServer::greet(Connection& connection, std::stop_token stop) {
  const Fault fault = faults_->next("camera", "accept", kConnectionFaults);
  if (fault == Fault::Exception) {
    connection.socket.write(ptp::encoded(Packet{PacketType::InitFail, DatasetWriter().u32(2).take()}), stop);  // busy
    return false;
  }
  DatasetWriter greeting;
  greeting.u32(1);                                     // the connection's number
  for (int i = 0; i < 16; ++i) greeting.u8(0x4c + i);  // who the camera is, the same at all times
  for (const char character : options_.model) greeting.u16(static_cast<unsigned char>(character));
  greeting.u16(0).u32(0x00010000);  // PTP/IP 1.0
  return send(connection, whole(ptp::encoded(Packet{PacketType::InitCommandAck, greeting.take()})), fault, stop);
}

std::vector<Fault> PtpCameraServer::capture_faults() const {
  std::vector<Fault> possible = kConnectionFaults;
  possible.insert(possible.end(), {Fault::Wedge, Fault::CardFull, Fault::LateSettings, Fault::FalseMetadata});
  if (shutter_.has_picture()) possible.push_back(Fault::StaleFrame);
  return possible;
}

bool PtpCameraServer::answer(Connection& connection, const Packet& packet, std::uint64_t session,
                             std::stop_token stop) {
  const auto request = ptp::read_request(packet, connection.socket, stop);
  if (!request) return false;
  const std::string name = operation_name(request->operation);
  const Fault fault = faults_->next("camera", name, name == "capture" ? capture_faults() : kConnectionFaults);
  if (fault == Fault::Mute) return true;
  if (fault == Fault::Disconnect) {
    const std::lock_guard lock(mutex_);
    hang_up();
    return false;
  }
  return send(connection, ptp::encoded(carry_out(*request, session, fault), request->transaction), fault, stop);
}

ptp::Reply PtpCameraServer::carry_out(const ptp::Request& request, std::uint64_t session, Fault fault) {
  const std::scoped_lock lock(operations_mutex_, mutex_);
  if (fault == Fault::CardFull) return {ptp::Response::StoreFull, {}, nullptr};
  if (fault == Fault::Exception) {
    return {faults_->detail() < 0.5 ? ptp::Response::DeviceBusy : ptp::Response::GeneralError, {}, nullptr};
  }
  if (fault == Fault::Wedge) wedged_ = true;
  const bool swallowed = wedged_ && request.operation == ptp::Operation::InitiateCapture;
  return swallowed ? ptp::Reply{} : operations_.answer(request, session, fault);
}

bool PtpCameraServer::send(Connection& connection, const EncodedReply& reply, Fault fault, std::stop_token stop) {
  switch (fault) {
    case Fault::Mute:
      return true;
    case Fault::Disconnect:
      return false;
    case Fault::HalfReply:
      ptp::write_reply(connection.socket, reply, reply.size() / 2, stop);
      return false;
    case Fault::Garbage: {
      std::vector<std::uint8_t> noise(64);
      for (std::uint8_t& byte : noise) byte = static_cast<std::uint8_t>(256.0 * faults_->detail());
      return connection.socket.write(noise, stop);
    }
    case Fault::LateReply: {
      SystemClock clock;  // the client waits in real time, whatever the bench's clock does
      clock.sleep_until(clock.now_s() + options_.late_reply_s, stop);
      break;
    }
    default:
      break;
  }
  return ptp::write_reply(connection.socket, reply, std::numeric_limits<std::size_t>::max(), stop);
}

// Only whoever released the shutter is told, and only while it is connected.
void PtpCameraServer::tell(const ptp::Release& release, ptp::EventCode code, std::uint32_t parameter,
                           std::stop_token stop) {
  const Fault fault = faults_->next("camera", "event", kEventFaults);
  if (fault == Fault::LateReply) {
    SystemClock clock;
    clock.sleep_until(clock.now_s() + options_.late_reply_s, stop);
  }
  DatasetWriter body;
  body.u16(static_cast<std::uint16_t>(code)).u32(release.transaction).u32(parameter);
  const EncodedReply event = whole(ptp::encoded(Packet{PacketType::Event, body.take()}));
  const std::lock_guard lock(mutex_);
  if (events_ == nullptr || release.session != session_) return;
  if (fault == Fault::Disconnect) return hang_up();
  const bool stays = send(*events_, event, fault == Fault::LateReply ? Fault::None : fault, stop);
  if (!stays) events_->socket.shut_down();
}

}  // namespace lumitexel
