#include "tests/protocol/gige/gige_bench.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>

#include "drivers/error.h"
#include "tests/protocol/hastened_clock.h"
#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

std::string next_address() {
  static std::atomic<std::uint64_t> used = 0;
  const std::uint64_t place = scrambled(static_cast<std::uint64_t>(getpid())) + used++;
  const auto part = [&](int shift) { return std::to_string(1 + (place >> shift) % 254); };
  return "127." + part(16) + "." + part(8) + "." + part(0);
}

std::vector<std::uint16_t> pattern(const CameraLimits& limits, const WorldState& state, const CameraSettings& settings,
                                   std::uint64_t noise_key) {
  std::vector<std::uint16_t> samples;
  const unsigned most = (1u << limits.bits) - 1u;
  const auto shift = static_cast<unsigned>(settings.exposure_s * 1e5 + settings.gain_db * 7 + state.turntable_deg);
  for (int y = 0; y < limits.height_px; ++y) {
    for (int x = 0; x < limits.width_px; ++x) {
      const auto noise = static_cast<unsigned>(scrambled(noise_key + static_cast<std::uint64_t>(x)) & 3u);
      samples.push_back(static_cast<std::uint16_t>((17u * x + 301u * y + shift + noise) & most));
    }
  }
  return samples;
}

}  // namespace

CameraLimits small_limits(int bits, Mosaic mosaic) {
  return {.width_px = 64, .height_px = 48, .bits = bits, .mosaic = mosaic, .exposure_min_s = 1e-5,
          .exposure_max_s = 10.0, .exposure_step_s = 1e-6, .readout_s = 0.01, .gain_min_db = 0.0, .gain_max_db = 24.0};
}

std::shared_ptr<SimulatedBench> pattern_bench(const CameraLimits& sensor) {
  RigDescription rig;
  rig.camera.limits = sensor;
  rig.turntable.speed_deg_per_s = 20.0;
  rig.light_positioner.speed_deg_per_s = 15.0;
  BenchBehaviour behaviour;
  behaviour.state_strip = true;
  behaviour.sensor_temperature_c = 31.5;
  return std::make_shared<SimulatedBench>(
      rig, behaviour, std::make_shared<HastenedClock>(20.0),
      [sensor](const WorldState& state, const CameraSettings& settings, std::uint64_t noise_key) {
        return pattern(sensor, state, settings, noise_key);
      });
}

std::unique_ptr<GigeCameraServer> serve_camera(std::shared_ptr<SimulatedBench> bench, GigeCameraOptions options,
                                               std::shared_ptr<FaultSource> faults) {
  for (int tries_left = 50;; --tries_left) {
    options.address = next_address();
    try {
      return std::make_unique<GigeCameraServer>(bench, options, faults);
    } catch (const Disconnected&) {
      if (tries_left == 0) throw;
    }
  }
}

AravisConnection unnamed_connection_to(const GigeCameraServer& server) {
  AravisConnection connection;
  connection.address = server.address();
  connection.packet_size_bytes = 576;
  connection.answer_timeout_s = 1.0;
  connection.reconnect_timeout_s = 8.0;
  return connection;
}

AravisConnection connection_to(const GigeCameraServer& server) {
  AravisConnection connection = unnamed_connection_to(server);
  connection.frame_name_feature = "FrameName";
  connection.frame_name_chunk = "ChunkFrameName";
  return connection;
}

std::unique_ptr<AravisCamera> connect(const AravisConnection& connection, const CameraLimits& limits) {
  return std::make_unique<AravisCamera>(connection, limits, std::make_shared<SystemClock>());
}

std::shared_ptr<std::vector<DiscardedFrame>> record_discards(Camera& camera) {
  auto discards = std::make_shared<std::vector<DiscardedFrame>>();
  camera.on_discard([discards](const DiscardedFrame& frame) { discards->push_back(frame); });
  return discards;
}

StateStrip strip_of(const Frame& frame) {
  const auto strip = read_state_strip(frame.samples, frame.bits);
  EXPECT_TRUE(strip.has_value()) << "the frame's pixels carry no state strip";
  return strip.value_or(StateStrip{});
}

std::vector<std::uint16_t> expected_samples(SimulatedBench& bench, const Frame& frame) {
  const StateStrip strip = strip_of(frame);
  // The same key and state give the same exposure, but for its count, which the strip holds.
  const CameraSettings settings = quantise(strip.settings, bench.camera().limits, "strip");
  std::vector<std::uint16_t> samples = bench.expose(settings, strip.frame_key, {}).samples;
  write_state_strip(strip, frame.bits, samples);
  return samples;
}

}  // namespace lumitexel
