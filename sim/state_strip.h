// The bench's state written into the first pixels of a frame, a bit a pixel, black or white: what a delivered frame really
// shows can then be proven from its pixels alone, whatever its metadata say.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "drivers/camera.h"
#include "sim/world_state.h"

namespace lumitexel {

struct StateStrip {
  CameraSettings settings;  // exposure to the nanosecond, gain to 0.001 dB
  WorldState state;         // angles to 0.001 degrees; without what drifts over the session
  std::uint64_t frame_key = 0;
  std::uint64_t exposure_count = 0;  // SimulatedBench's, below 2^48
};

inline constexpr std::size_t kStateStripPixels = 408;

// bits: of the sensor's samples. Throws OutOfRange if the frame has fewer than kStateStripPixels samples.
void write_state_strip(const StateStrip& strip, int bits, std::vector<std::uint16_t>& samples);

// Empty if there is none or its check sum is wrong.
std::optional<StateStrip> read_state_strip(std::span<const std::uint16_t> samples, int bits);

}  // namespace lumitexel
