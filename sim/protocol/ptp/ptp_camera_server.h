// A still camera that speaks PTP/IP, over a simulated bench: libgphoto2's ptp2 driver and others take pictures with it.
//
// A picture is a DNG of what the bench's camera sees, with the exposure and the ISO value that were set; its noise is
// that of the frame that the setting "artist" names (drivers/gphoto/frame_name.h), else of the camera's count of
// pictures. Bulb, several pictures a release, live view and vendors' extensions are not there.
//
// Faults are asked for as device "camera": "accept" for a connection, "operation", "capture", "transfer" for requests,
// "event" for what the camera reports by itself. LateReply comes after late_reply_s. A wedged camera goes on answering
// and finishes no picture until its client connects anew.
#pragma once

#include <atomic>
#include <cstdint>
#include <list>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "sim/fault_source.h"
#include "sim/protocol/ptp/operations.h"

namespace lumitexel {

struct PtpCameraOptions {
  std::string address = "127.0.0.1";
  int command_port = 15740;  // 0: any free one
  int event_port = 15740;    // the same as command_port: one port for both
  std::string make = "Lumitexel", model = "Simulated still camera", serial = "0001";
  std::vector<int> iso_choices = {100, 200, 400, 800, 1600, 3200};
  double iso_at_0_db = 100.0;
  double late_reply_s = 3.0;  // libgphoto2 gives up after 2.5 s
};

class PtpCameraServer {
 public:
  // Serves as soon as it exists. Throws BadInput for an address that cannot be bound or exposures that PTP cannot say.
  PtpCameraServer(std::shared_ptr<SimulatedBench> bench, std::shared_ptr<FaultSource> faults,
                  const PtpCameraOptions& options = {});
  ~PtpCameraServer();

  // libgphoto2's name for where it is: "ptpip:127.0.0.1:40001:40001".
  std::string gphoto_port() const;
  // The cable: without it every connection ends, and new ones end at once.
  void plug(bool plugged_in);

 private:
  struct Connection {
    ptp::Socket socket;
    std::atomic<bool> done = false;
    std::jthread thread;
  };
  void accept_from(const ptp::Socket& listener, std::stop_token stop);
  void serve(Connection& connection, std::stop_token stop);
  void serve_events(Connection& connection, std::stop_token stop);
  void serve_commands(Connection& connection, std::stop_token stop);
  bool greet(Connection& connection, std::stop_token stop);
  bool answer(Connection& connection, const ptp::Packet& packet, std::uint64_t session, std::stop_token stop);
  ptp::Reply carry_out(const ptp::Request& request, std::uint64_t session, Fault fault);
  bool send(Connection& connection, const ptp::EncodedReply& reply, Fault fault, std::stop_token stop);
  void tell(const ptp::Release& release, ptp::EventCode code, std::uint32_t parameter, std::stop_token stop);
  std::vector<Fault> capture_faults() const;
  void hang_up();
  void leave(Connection& connection);

  std::shared_ptr<FaultSource> faults_;
  PtpCameraOptions options_;
  ptp::CameraProperties properties_;
  ptp::MemoryCard card_;
  ptp::ShutterIdentity identity_;
  ptp::Socket command_listener_, event_listener_;

  std::mutex operations_mutex_;  // properties and operations
  std::mutex mutex_;             // the rest
  bool plugged_in_ = true, wedged_ = false;
  std::uint64_t session_ = 0;  // the latest command connection's number
  Connection* commands_ = nullptr;
  Connection* events_ = nullptr;
  std::list<Connection> connections_;
  ptp::Shutter shutter_;
  ptp::Operations operations_;
  std::vector<std::jthread> acceptors_;
};

}  // namespace lumitexel
