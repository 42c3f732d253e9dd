// A small bench whose camera is reached over PTP/IP, and the driver's way to it.
#pragma once

#include <memory>
#include <string>

#include "drivers/gphoto/gphoto_camera.h"
#include "sim/protocol/ptp/ptp_camera_server.h"
#include "sim/simulated_bench.h"

namespace lumitexel {

// 64 x 48 pixels, 14 bits, RGGB; seven exposures, four ISO values a doubling apart.
RigDescription still_rig();

// A pattern in which every pixel depends on place, settings, state and key; the first pixels carry the state strip.
std::shared_ptr<SimulatedBench> still_bench(const RigDescription& rig = still_rig(), double hasten = 1.0);
std::vector<std::uint16_t> still_pixels(const CameraLimits& limits, const WorldState& state,
                                        const CameraSettings& settings, std::uint64_t noise_key);

// Any free port; late replies come after late_reply_s.
std::unique_ptr<PtpCameraServer> serve(std::shared_ptr<SimulatedBench> bench, std::shared_ptr<FaultSource> faults,
                                       double late_reply_s = 3.0);

GphotoConnection connection_to(const PtpCameraServer& server, double answer_timeout_s = 5.0);

// Empty if the frame's pixels, file and reported settings all belong to this shot; else what does not.
std::string objection_to(const Frame& frame, const CameraSettings& settings, std::uint64_t key,
                         const RigDescription& rig = still_rig());

// Whether there is such a process, other than as one that waits to be collected by somebody else.
bool is_alive(pid_t pid);

}  // namespace lumitexel
