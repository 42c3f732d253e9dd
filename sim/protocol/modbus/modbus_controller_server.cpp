#include "sim/protocol/modbus/modbus_controller_server.h"

#include <arpa/inet.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <optional>
#include <thread>

#include "drivers/error.h"
#include "sim/protocol/modbus/pseudo_terminal.h"

namespace lumitexel {
namespace {

using SteadyTime = std::chrono::steady_clock::time_point;
using std::chrono::milliseconds;

constexpr milliseconds kTick{5};          // how late a late reply, the watchdog or a port may be
constexpr milliseconds kFrameGap{20};     // a request on a serial line that pauses for so long is none
constexpr milliseconds kUnplugged{50};

const char* const kDevice = "controller";
const std::vector<Fault> kConnectionFaults{Fault::Mute,    Fault::LateReply, Fault::Exception,
                                           Fault::Garbage, Fault::HalfReply, Fault::Disconnect};

FileDescriptor listen_at(ModbusEndpoint& endpoint) {
  const auto failed = [&](const std::string& what) {
    return Error("simulated controller at " + endpoint.host + ":" + std::to_string(endpoint.port) + ": cannot " + what +
                 ": " + std::strerror(errno));
  };
  FileDescriptor listener(socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (!listener.valid()) throw failed("open a socket");
  const int on = 1;
  setsockopt(listener.get(), SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(endpoint.port));
  if (inet_pton(AF_INET, endpoint.host.c_str(), &address.sin_addr) != 1) throw failed("use such an address");
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  if (bind(listener.get(), generic, size) != 0) throw failed("bind");
  if (listen(listener.get(), 8) != 0) throw failed("listen");
  if (getsockname(listener.get(), generic, &size) != 0) throw failed("find out its port");
  endpoint.port = ntohs(address.sin_port);
  return listener;
}

struct LateBytes {
  Bytes bytes;
  SteadyTime due;
};

struct Connection {
  FileDescriptor socket;    // TCP
  int fd = -1;              // of the socket, or the terminal's
  bool deaf = false;        // Fault::Mute when it was accepted
  Bytes received;
  SteadyTime last_byte;
  std::optional<LateBytes> late;  // nothing else is answered before it
};

}  // namespace

// One thread does all, so that requests are carried out one after the other as in a real controller.
class ModbusControllerServer::Serving {
 public:
  Serving(const ModbusServerSettings& settings, std::shared_ptr<SimulatedBench> bench,
          std::shared_ptr<FaultSource> faults)
      : settings_(settings),
        framing_(settings.endpoint.host.empty() ? Framing::Rtu : Framing::Tcp),
        faults_(std::move(faults)),
        controller_(std::move(bench), settings.endpoint, settings.axes, settings.lamps, settings.behaviour),
        wake_(eventfd(0, EFD_CLOEXEC)) {
    if (framing_ == Framing::Tcp) {
      listener_ = listen_at(settings_.endpoint);
    } else {
      terminal_.emplace(settings_.endpoint.serial_device);
      settings_.endpoint.serial_device = terminal_->path();
      open_terminal();
    }
    thread_ = std::jthread([this](std::stop_token stop) { serve(stop); });
  }
  ~Serving() {
    thread_.request_stop();
    const std::uint64_t one = 1;
    if (::write(wake_.get(), &one, sizeof one) < 0) return;  // the next tick will do
  }

  const ModbusServerSettings& settings() const { return settings_; }
  const SimulatedController& controller() const { return controller_; }

 private:
  void serve(std::stop_token stop) {
    while (!stop.stop_requested()) {
      wait();
      const SteadyTime now = std::chrono::steady_clock::now();
      controller_.check_watchdog(now);
      if (terminal_ && connections_.empty() && now >= plug_in_at_) {
        terminal_->plug_in();
        open_terminal();
      }
      for (Connection& connection : connections_) tend(connection, now);
      std::erase_if(connections_, [](const Connection& connection) { return connection.fd < 0; });
      if (listener_.valid()) accept_waiting();
    }
  }

  void wait() {
    std::vector<pollfd> waiting{{wake_.get(), POLLIN, 0}};
    if (listener_.valid()) waiting.push_back({listener_.get(), POLLIN, 0});
    for (const Connection& connection : connections_) {
      if (!connection.late) waiting.push_back({connection.fd, POLLIN, 0});
    }
    poll(waiting.data(), waiting.size(), static_cast<int>(kTick.count()));
  }

  void accept_waiting() {
    Connection connection;
    connection.socket = FileDescriptor(accept4(listener_.get(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!connection.socket.valid()) return;
    connection.fd = connection.socket.get();
    const int on = 1;
    setsockopt(connection.fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    const Fault fault = faults_->next(kDevice, "accept", {Fault::Mute, Fault::Disconnect});
    if (fault == Fault::Disconnect) return;
    connection.deaf = fault == Fault::Mute;
    connections_.push_back(std::move(connection));
  }

  void open_terminal() {
    Connection connection;
    connection.fd = terminal_->master_fd();
    connections_.push_back(std::move(connection));
  }

  void drop(Connection& connection) {
    connection.socket.reset();
    connection.fd = -1;
    if (!terminal_) return;
    terminal_->unplug();
    plug_in_at_ = std::chrono::steady_clock::now() + kUnplugged;
  }

  void tend(Connection& connection, SteadyTime now) {
    if (connection.late) {
      if (now < connection.late->due) return;
      send(connection, connection.late->bytes);
      connection.late.reset();
    }
    receive(connection, now);
    while (connection.fd >= 0 && !connection.late) {
      const std::optional<ModbusFrame> frame = take_frame(framing_, connection.received);
      if (!frame) break;
      if (!connection.deaf && addressed(*frame)) handle(connection, *frame);
    }
  }

  // By TCP the unit is the gateway's business; on a line several units listen.
  bool addressed(const ModbusFrame& frame) const {
    return framing_ == Framing::Tcp || frame.unit == settings_.endpoint.unit_id;
  }

  void receive(Connection& connection, SteadyTime now) {
    if (framing_ == Framing::Rtu && now - connection.last_byte > kFrameGap) connection.received.clear();
    std::array<std::uint8_t, 512> part{};
    for (;;) {
      const ssize_t got = ::read(connection.fd, part.data(), part.size());
      if (got > 0) {
        connection.received.insert(connection.received.end(), part.begin(), part.begin() + got);
        connection.last_byte = now;
        continue;
      }
      if (got < 0 && errno == EINTR) continue;
      // A terminal has no end that its other side could close.
      if (framing_ == Framing::Tcp && (got == 0 || errno != EAGAIN)) drop(connection);
      return;
    }
  }

  void send(Connection& connection, const Bytes& bytes) {
    const ssize_t sent = framing_ == Framing::Tcp ? ::send(connection.fd, bytes.data(), bytes.size(), MSG_NOSIGNAL)
                                                  : ::write(connection.fd, bytes.data(), bytes.size());
    if (sent < 0 && framing_ == Framing::Tcp) drop(connection);
  }

  void handle(Connection& connection, const ModbusFrame& frame) {
    const bool diagnostics = framing_ == Framing::Rtu && frame.pdu[0] == kDiagnosticsFunction;
    if (diagnostics && !settings_.knows_diagnostics) return;
    const ModbusRequest request = parse_request(frame.pdu);
    std::vector<Fault> possible = kConnectionFaults;
    for (const Fault fault : controller_.possible_faults(request)) possible.push_back(fault);
    const Fault fault =
        faults_->next(kDevice, diagnostics ? "diagnostics" : request.writes ? "write" : "read", possible);
    const bool lost_before = (fault == Fault::Mute || fault == Fault::Disconnect) && faults_->detail() < 0.5;
    Bytes reply;
    if (fault == Fault::Exception) reply = exception_reply(frame.pdu, some_exception());
    else if (diagnostics) reply = frame.pdu;
    else if (!lost_before) reply = controller_.answer(frame.pdu, fault);
    deliver(connection, framed(framing_, frame, reply), fault);
  }

  void deliver(Connection& connection, Bytes reply, Fault fault) {
    switch (fault) {
      case Fault::Mute: return;
      case Fault::Disconnect: drop(connection); return;
      case Fault::LateReply:
        connection.late =
            LateBytes{std::move(reply), std::chrono::steady_clock::now() +
                                            std::chrono::microseconds(std::llround(settings_.late_by_s * 1e6))};
        return;
      case Fault::HalfReply: reply.resize(reply.size() / 2); break;
      case Fault::Garbage: reply = garbage(); break;
      default: break;
    }
    send(connection, reply);
  }

  Bytes garbage() {
    constexpr double kMost = 40.0;
    Bytes bytes(static_cast<std::size_t>(1.0 + kMost * faults_->detail()));
    for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(256.0 * faults_->detail());
    return bytes;
  }

  ModbusException some_exception() {
    const double drawn = faults_->detail();
    return drawn < 1.0 / 3.0   ? ModbusException::Busy
           : drawn < 2.0 / 3.0 ? ModbusException::Acknowledge
                               : ModbusException::Failure;
  }

  ModbusServerSettings settings_;
  Framing framing_;
  std::shared_ptr<FaultSource> faults_;
  SimulatedController controller_;
  FileDescriptor wake_, listener_;
  std::optional<PseudoTerminal> terminal_;
  SteadyTime plug_in_at_;
  std::vector<Connection> connections_;
  std::jthread thread_;  // last: it uses all of the above
};

ModbusControllerServer::ModbusControllerServer(const ModbusServerSettings& settings,
                                               std::shared_ptr<SimulatedBench> bench,
                                               std::shared_ptr<FaultSource> faults)
    : serving_(std::make_unique<Serving>(settings, std::move(bench), std::move(faults))) {}

ModbusControllerServer::~ModbusControllerServer() = default;

const ModbusEndpoint& ModbusControllerServer::endpoint() const { return serving_->settings().endpoint; }

const SimulatedController& ModbusControllerServer::controller() const { return serving_->controller(); }

}  // namespace lumitexel
