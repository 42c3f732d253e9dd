#include "drivers/aravis/aravis_camera.h"

#include <cmath>

#include "drivers/aravis/aravis_device.h"
#include "drivers/aravis/aravis_stream.h"
#include "drivers/aravis/genicam_settings.h"
#include "drivers/aravis/received_frame.h"
#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr double kBetweenAttempts_s = 0.1;  // to reconnect
// Of two conversions from ticks to nanoseconds.
constexpr std::uint64_t kTimestampRounding_ns = 1000;

}  // namespace

struct AravisCamera::Link {
  Link(const std::string& address, const std::string& name) : device(address, name) {}
  // A stream at rest, so that the next program finds the camera ready. It may be gone: then there is nothing to stop.
  ~Link() {
    GErrorSlot ignored;
    if (stream && !failed && !device.control_lost()) arv_camera_stop_acquisition(device.camera(), ignored);
  }

  AravisDevice device;
  CameraSetup setup;
  std::unique_ptr<AravisStream> stream;
  GHandle<ArvChunkParser> chunks;
  std::optional<CameraSettings> applied;  // empty: whatever the registers hold
  bool failed = false;  // the last command found nobody
};

AravisCamera::AravisCamera(AravisConnection connection, CameraLimits limits, std::shared_ptr<Clock> clock)
    : connection_(std::move(connection)), limits_(std::move(limits)), clock_(std::move(clock)) {
  connect();
}

AravisCamera::~AravisCamera() = default;

void AravisCamera::connect() {
  link_ = std::make_unique<Link>(connection_.address, name());
  try {
    restart();
  } catch (...) {
    link_->failed = true;
    link_.reset();
    throw;
  }
}

// Everything is set anew, whatever the camera remembers; late frames go with the old stream.
void AravisCamera::restart() {
  ++restarts_;
  link_->applied.reset();
  link_->stream.reset();
  link_->setup = set_up(link_->device, connection_, limits_);
  if (link_->setup.any_chunk()) link_->chunks = link_->device.chunk_parser();
  link_->stream = std::make_unique<AravisStream>(link_->device, link_->setup.payload_bytes);
}

AravisCamera::Link& AravisCamera::link(const std::string& asked) {
  if (!link_) throw Disconnected(name() + ": " + asked + ": not connected");
  return *link_;
}

CameraSettings AravisCamera::arm(const CameraSettings& settings, std::stop_token stop) {
  if (stop.stop_requested()) throw Cancelled(name() + ": arming: cancelled");
  Link& camera = link("arming");
  if (camera.applied != settings) {
    camera.applied.reset();  // until both are set
    apply_settings(camera.device, camera.setup, settings);
    camera.applied = settings;
  }
  return read_settings(camera.device, camera.setup);
}

Frame AravisCamera::trigger(std::uint64_t frame_key, std::stop_token stop) {
  Link& camera = link("triggering");
  const double exposure_s = camera.applied ? camera.applied->exposure_s : limits_.exposure_max_s;
  const std::string asked = "triggered frame " + std::to_string(frame_key);
  camera.stream->drop_waiting();
  if (!connection_.frame_name_feature.empty()) {
    camera.device.set(connection_.frame_name_feature, static_cast<std::int64_t>(frame_key));
  }
  const bool dated = camera.setup.latch != CameraSetup::Latch::None;
  const std::uint64_t triggered_ns = dated ? latched_time_ns(camera.device, camera.setup) : 0;
  camera.device.call("software trigger", arv_camera_software_trigger);
  const double deadline_s = clock_->now_s() + exposure_s + limits_.readout_s + connection_.answer_timeout_s;
  const AravisStream::Buffer buffer = camera.stream->wait(*clock_, deadline_s, asked, stop);
  if (dated && arv_buffer_get_timestamp(buffer.get()) + kTimestampRounding_ns < triggered_ns) {
    throw Protocol(name() + ": " + asked + ", an earlier frame came (of before the trigger)");
  }
  Frame frame = received_frame(buffer.get(), camera.chunks.get(), camera.setup, limits_, connection_.frame_name_chunk,
                               name());
  // A camera counts anew after each restart, which must not make a new frame look like an old one; that it is new, its
  // time tells. Without that, the bare count is all there is.
  if (dated) frame.device_frame_id |= restarts_ << 32;
  if (std::isnan(frame.reported.exposure_s) || std::isnan(frame.reported.gain_db)) {
    const CameraSettings registers = read_settings(camera.device, camera.setup);
    if (std::isnan(frame.reported.exposure_s)) frame.reported.exposure_s = registers.exposure_s;
    if (std::isnan(frame.reported.gain_db)) frame.reported.gain_db = registers.gain_db;
  }
  if (camera.setup.temperature) {
    const double temperature_c = camera.device.real(connection_.temperature_feature);
    if (std::isfinite(temperature_c)) frame.sensor_temperature_c = temperature_c;
  }
  return frame;
}

// The commands on either side of a lost frame, each up to 2.5 s, beside what is stated.
double AravisCamera::longest_recovery_s() const {
  constexpr double kCommands_s = 20.0;
  return connection_.reconnect_timeout_s + connection_.answer_timeout_s + kCommands_s;
}

void AravisCamera::recover(std::stop_token stop) {
  const double deadline_s = clock_->now_s() + connection_.reconnect_timeout_s;
  if (link_) {
    try {
      link_->device.require_present();
      link_->device.take_control();
      link_->device.require_same();  // the description in hand is the old one's
      return restart();
    } catch (const Timeout&) {
    } catch (const Disconnected&) {
    } catch (const Protocol&) {
    } catch (...) {  // a camera that cannot be set up as the rig wants is none
      link_->failed = true;
      link_.reset();
      throw;
    }
    link_->failed = true;  // nobody there, or nobody who listens to us
    link_.reset();
  }
  while (true) {
    try {
      return connect();
    } catch (const BadInput&) {
      throw;  // another camera answers at this address: no use in asking again
    } catch (const OutOfRange&) {
      throw;
    } catch (const Error&) {
      if (clock_->now_s() >= deadline_s) throw;
    }
    clock_->sleep_until(clock_->now_s() + kBetweenAttempts_s, stop);
  }
}

}  // namespace lumitexel
