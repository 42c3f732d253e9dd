#include "tests/protocol/session/protocol_rig.h"

#include <stdlib.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>

#include "drivers/error.h"
#include "rig/hardware_devices.h"
#include "rig/rig_file.h"
#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

// Deadlines in seconds: short, so that a fault costs little, and long enough for a loaded machine.
constexpr double kControllerAnswer_s = 0.15, kControllerLate_s = 0.25, kControllerGiveUp_s = 2.0;
constexpr double kFrameAnswer_s = 1.0, kCameraReconnect_s = 8.0, kStillAnswer_s = 4.0;
constexpr double kSettle_s = 0.004, kLampSettle_s = 0.001;
constexpr int kPacket_bytes = 576;  // so that a small frame is several packets

std::string loopback_file(CameraKind camera) {
  const std::string folder = LUMITEXEL_SOURCE_DIR "/config/rigs/";
  return folder + (camera == CameraKind::Gige ? "loopback.toml" : "loopback_still_camera.toml");
}

// No two processes ask for the same ones first.
std::string next_address() {
  static std::atomic<std::uint64_t> used = 0;
  const std::uint64_t place = scrambled(0x5e5510ULL + static_cast<std::uint64_t>(getpid())) + used++;
  const auto part = [&](int shift) { return std::to_string(1 + (place >> shift) % 254); };
  return "127." + part(16) + "." + part(8) + "." + part(0);
}

std::vector<std::uint16_t> pattern(const CameraLimits& limits, const WorldState& state, const CameraSettings& settings,
                                   std::uint64_t noise_key) {
  const auto most = (1u << limits.bits) - 1u;
  const auto shift = static_cast<std::uint64_t>(settings.exposure_s * 1e6 + state.turntable_deg);
  std::vector<std::uint16_t> samples(static_cast<std::size_t>(limits.width_px) *
                                     static_cast<std::size_t>(limits.height_px));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = static_cast<std::uint16_t>(scrambled(noise_key + shift + i) & most);
  }
  return samples;
}

std::shared_ptr<SimulatedBench> pattern_bench(const RigDescription& rig, std::uint64_t seed) {
  BenchBehaviour behaviour;
  behaviour.seed = seed;
  behaviour.state_strip = true;
  return std::make_shared<SimulatedBench>(
      rig, behaviour, std::make_shared<SystemClock>(),
      [limits = rig.camera.limits](const WorldState& state, const CameraSettings& settings, std::uint64_t key) {
        return pattern(limits, state, settings, key);
      });
}

void connect_quickly(AravisConnection& camera, bool frames_named) {
  camera.packet_size_bytes = kPacket_bytes;
  camera.answer_timeout_s = kFrameAnswer_s;
  camera.reconnect_timeout_s = kCameraReconnect_s;
  if (frames_named) return;
  camera.frame_name_feature.clear();
  camera.frame_name_chunk.clear();
}

}  // namespace

RigDescription quick_rig(CameraKind camera, double speed_deg_per_s) {
  const std::string file = loopback_file(camera);
  RigDescription rig = parse_rig(read_rig_file(file), file);
  CameraLimits& limits = rig.camera.limits;
  limits.width_px = 32;
  limits.height_px = 24;
  limits.readout_s = 0.001;
  if (camera == CameraKind::Gige) {
    limits.bits = 12;
    limits.mosaic = Mosaic::Mono;
    limits.gain_min_db = 0.0;
    limits.gain_max_db = 24.0;
  } else {
    limits.exposure_choices_s = {0.001, 0.002, 0.004, 0.008, 0.016};
    limits.exposure_min_s = limits.exposure_choices_s.front();
    limits.exposure_max_s = limits.exposure_choices_s.back();
    limits.gain_min_db = 0.0;
    limits.gain_max_db = 20.0 * std::log10(8.0);
    limits.gain_step_db = 20.0 * std::log10(2.0);
  }
  rig.turntable.speed_deg_per_s = rig.light_positioner.speed_deg_per_s = speed_deg_per_s;
  rig.turntable.settle_s = rig.light_positioner.settle_s = kSettle_s;
  return rig;
}

ProtocolRig::ProtocolRig(const ProtocolRigOptions& options)
    : ProtocolRig(options, quick_rig(options.camera, options.speed_deg_per_s),
                  pattern_bench(quick_rig(options.camera, options.speed_deg_per_s), options.seed)) {}

ProtocolRig::ProtocolRig(const ProtocolRigOptions& options, const RigDescription& rig,
                         std::shared_ptr<SimulatedBench> bench)
    : rig_(rig), bench_(std::move(bench)) {
  rig_.camera.limits.settings_latency_frames = options.declared_latency_frames;
  describe(options);
  ServedRigOptions serving = options.serving;
  serving.controller_late_by_s = kControllerLate_s;
  for (int tries_left = 50;; --tries_left) {
    place_at(next_address());
    try {
      served_ = std::make_unique<ServedRig>(hardware_, bench_, options.faults, serving);
      return;
    } catch (const Error&) {  // somebody else is there
      if (tries_left == 0) throw;
    }
  }
}

void ProtocolRig::describe(const ProtocolRigOptions& options) {
  const std::string file = loopback_file(options.camera);
  hardware_ = parse_hardware(parse_rig(read_rig_file(file), file).hardware_toml, file);
  if (auto* gige = std::get_if<AravisConnection>(&hardware_.camera)) connect_quickly(*gige, options.frames_named);
  else std::get<GphotoConnection>(hardware_.camera).answer_timeout_s = kStillAnswer_s;
  for (auto& [name, endpoint] : hardware_.controllers) {
    endpoint.response_timeout_s = kControllerAnswer_s;
    endpoint.give_up_s = kControllerGiveUp_s;
  }
  hardware_.controllers.at("arm").serial_device = (folder_ / "arm").string();
  for (ModbusLampMap* lamp : {&hardware_.point_light, &hardware_.ring_flash, &hardware_.backlight}) {
    lamp->settle_s = kLampSettle_s;
  }
}

void ProtocolRig::place_at(const std::string& address) {
  hardware_.controllers.at("table").host = address;
  if (auto* gige = std::get_if<AravisConnection>(&hardware_.camera)) gige->address = address;
  else std::get<GphotoConnection>(hardware_.camera).port = "ptpip:" + address;
}

RigDevices ProtocolRig::connect(std::stop_token stop) const {
  return connect_hardware(rig_, hardware_, std::move(stop));
}

void ProtocolRig::mend() {
  for (const BenchAxis axis : kBenchAxes) bench_->jam(axis, false);
  for (const BenchLamp lamp : kBenchLamps) bench_->break_lamp(lamp, false);
}

bool ProtocolRig::is_at_rest() const {
  return std::none_of(kBenchLamps.begin(), kBenchLamps.end(), [&](BenchLamp lamp) { return bench_->is_lit(lamp); }) &&
         std::none_of(kBenchAxes.begin(), kBenchAxes.end(),
                      [&](BenchAxis axis) { return bench_->motion(axis).moving; });
}

void offer_only_the_ptp_driver() {
  static const TemporaryFolder folder;
  const std::filesystem::path link = folder / "ptp2.so";
  if (std::filesystem::exists(link)) return;
  std::filesystem::create_symlink(std::filesystem::path(LUMITEXEL_GPHOTO_DRIVERS) / "ptp2.so", link);
  setenv("CAMLIBS", folder.path().c_str(), 1);
  setenv("LUMITEXEL_GPHOTO_WORKER", LUMITEXEL_GPHOTO_WORKER, 1);
}

}  // namespace lumitexel
