#include "tests/protocol/ptp/still_bench.h"

#include <cmath>
#include <fstream>
#include <sstream>

#include "drivers/gphoto/camera_raw.h"
#include "tests/protocol/hastened_clock.h"
#include "sim/seeded_random.h"
#include "sim/state_strip.h"

namespace lumitexel {

RigDescription still_rig() {
  RigDescription rig;
  rig.camera.limits = {.width_px = 64,
                       .height_px = 48,
                       .bits = 14,
                       .mosaic = Mosaic::Rggb,
                       .exposure_min_s = 1e-3,
                       .exposure_max_s = 30.0};
  rig.camera.limits.exposure_choices_s = {0.001, 0.002, 0.004, 0.0125, 0.0333, 0.1, 30.0};
  rig.camera.limits.gain_min_db = 0.0;
  rig.camera.limits.gain_max_db = 20.0 * std::log10(8.0);
  rig.camera.limits.gain_step_db = 20.0 * std::log10(2.0);
  rig.camera.sensor.black_level_dn = 256.0;
  rig.turntable.speed_deg_per_s = 20.0;
  rig.light_positioner.speed_deg_per_s = 15.0;
  return rig;
}

std::vector<std::uint16_t> still_pixels(const CameraLimits& limits, const WorldState& state,
                                        const CameraSettings& settings, std::uint64_t noise_key) {
  std::vector<std::uint16_t> samples(static_cast<std::size_t>(limits.width_px) *
                                     static_cast<std::size_t>(limits.height_px));
  const auto lamps = static_cast<std::uint64_t>(state.point_light);
  const std::uint64_t key = noise_key ^ static_cast<std::uint64_t>(settings.exposure_s * 1e9) ^ (lamps << 60);
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = static_cast<std::uint16_t>(scrambled(key + i) & ((1u << limits.bits) - 1u));
  }
  return samples;
}

std::shared_ptr<SimulatedBench> still_bench(const RigDescription& rig, double hasten) {
  BenchBehaviour behaviour;
  behaviour.state_strip = true;
  const CameraLimits limits = rig.camera.limits;
  return std::make_shared<SimulatedBench>(
      rig, behaviour, std::make_shared<HastenedClock>(hasten),
      [limits](const WorldState& state, const CameraSettings& settings, std::uint64_t key) {
        return still_pixels(limits, state, settings, key);
      });
}

std::unique_ptr<PtpCameraServer> serve(std::shared_ptr<SimulatedBench> bench, std::shared_ptr<FaultSource> faults,
                                       double late_reply_s) {
  PtpCameraOptions options;
  options.command_port = options.event_port = 0;
  options.late_reply_s = late_reply_s;
  return std::make_unique<PtpCameraServer>(std::move(bench), std::move(faults), options);
}

GphotoConnection connection_to(const PtpCameraServer& server, double answer_timeout_s) {
  GphotoConnection connection;
  connection.model = "PTP/IP Camera";
  connection.port = server.gphoto_port();
  connection.frame_name_setting = "501e";  // EXIF artist: without a name in libgphoto2 for cameras of no known maker
  connection.answer_timeout_s = answer_timeout_s;
  connection.reconnect_timeout_s = 20.0;
  return connection;
}

std::string objection_to(const Frame& frame, const CameraSettings& settings, std::uint64_t key,
                         const RigDescription& rig) {
  const auto strip = read_state_strip(frame.samples, frame.bits);
  if (!strip) return "no state strip in its pixels";
  std::ostringstream text;
  if (!same_settings(strip->settings, {settings.exposure_s, std::round(settings.gain_db * 1e3) / 1e3})) {
    text << "taken with " << strip->settings.exposure_s << " s, " << strip->settings.gain_db << " dB; ";
  }
  if (!same_settings(frame.reported, settings)) text << "reports " << frame.reported.exposure_s << " s; ";
  if (strip->frame_key != key || frame.frame_key != key)
    text << "its pixels name the frame " << strip->frame_key << "; ";
  if (decode_camera_raw(frame.camera_file, "file").samples != frame.samples) text << "its file holds other pixels; ";
  if (frame.width_px != rig.camera.limits.width_px || frame.height_px != rig.camera.limits.height_px) text << "size; ";
  return text.str();
}

bool is_alive(pid_t pid) {
  std::ifstream file("/proc/" + std::to_string(pid) + "/stat");
  std::string number, name, state;
  return static_cast<bool>(file >> number >> name >> state) && state != "Z" && state != "X";
}

}  // namespace lumitexel
