// A GigE Vision or USB3 Vision camera, through Aravis and GenICam.
//
// GigE Vision is tested against simulated cameras over loopback. USB3 Vision goes the same way, opened by its id, but
// there is no simulated one: it has never been run.
//
// What a frame was taken with comes from its chunks where the camera has them, else from the registers after the frame.
// Where the camera tells its time, a frame exposed before its trigger is refused. The temperature is 0 where the camera
// tells none.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "drivers/aravis/aravis_connection.h"
#include "drivers/camera.h"
#include "drivers/clock.h"

namespace lumitexel {

class AravisCamera final : public Camera {
 public:
  // Connects, checks that the camera can do what the rig promises, sets all that stays and reads it back.
  // limits: of the rig's description; the size is the region's.
  // clock: the machine's own; a real camera is waited for in real time.
  // Throws Timeout (no answer), Disconnected (not found, or under another program's control), Protocol, and BadInput or
  // OutOfRange naming the key of the rig's description that this camera cannot satisfy.
  AravisCamera(AravisConnection connection, CameraLimits limits, std::shared_ptr<Clock> clock);
  ~AravisCamera() override;

  std::string name() const override { return "camera " + connection_.address; }
  CameraLimits limits() const override { return limits_; }

 protected:
  CameraSettings arm(const CameraSettings& settings, std::stop_token stop) override;
  // Deadline: exposure, readout and answer_timeout_s, beside the 2.5 s after which the library gives a command up.
  Frame trigger(std::uint64_t frame_key, std::stop_token stop) override;
  // Takes control again and sets, verifies and restarts everything; reconnects if that fails, until reconnect_timeout_s
  // is over. The camera's own deadline of a command comes on top.
  void recover(std::stop_token stop) override;
  double longest_recovery_s() const override;

 private:
  struct Link;
  void connect();
  void restart();
  Link& link(const std::string& asked);

  AravisConnection connection_;
  CameraLimits limits_;
  std::shared_ptr<Clock> clock_;
  std::unique_ptr<Link> link_;  // empty while not connected
  std::uint64_t restarts_ = 0;
};

}  // namespace lumitexel
