#include "sim/state_strip.h"

#include <array>
#include <cmath>
#include <string>

#include "drivers/error.h"
#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

constexpr std::uint64_t kMark = 0x4c75;  // "Lu"

// One field after the other, its lowest bit first.
class BitRow {
 public:
  void put(std::uint64_t value, int bits) {
    for (int i = 0; i < bits; ++i) bits_[place_++] = (value >> i) & 1u;
  }
  std::uint64_t take(int bits) {
    std::uint64_t value = 0;
    for (int i = 0; i < bits; ++i) value |= static_cast<std::uint64_t>(bits_[place_++]) << i;
    return value;
  }
  std::array<bool, kStateStripPixels>& bits() { return bits_; }
  std::uint64_t check_sum(std::size_t first_bits) const {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < first_bits; ++i) sum = scrambled(sum ^ (2 * i + (bits_[i] ? 1 : 0)));
    return sum;
  }
  std::size_t place() const { return place_; }

 private:
  std::array<bool, kStateStripPixels> bits_{};
  std::size_t place_ = 0;
};

std::uint64_t thousandths(double value) { return static_cast<std::uint64_t>(std::llround(value * 1000.0)); }
double from_thousandths(std::uint64_t bits) {
  return static_cast<double>(static_cast<std::int32_t>(static_cast<std::uint32_t>(bits))) / 1000.0;
}

}  // namespace

void write_state_strip(const StateStrip& strip, int bits, std::vector<std::uint16_t>& samples) {
  if (samples.size() < kStateStripPixels) {
    throw OutOfRange("state strip: needs " + std::to_string(kStateStripPixels) + " pixels, the frame has " +
                     std::to_string(samples.size()));
  }
  BitRow row;
  row.put(kMark, 16);
  row.put(static_cast<std::uint64_t>(std::llround(strip.settings.exposure_s * 1e9)), 64);
  row.put(thousandths(strip.settings.gain_db), 32);
  row.put(thousandths(strip.state.turntable_deg), 32);
  row.put(thousandths(strip.state.light_azimuth_deg), 32);
  row.put(thousandths(strip.state.light_elevation_deg), 32);
  row.put((strip.state.point_light ? 1u : 0u) | (strip.state.ring_flash ? 2u : 0u) | (strip.state.backlight ? 4u : 0u) |
              (strip.state.flat_field ? 8u : 0u), 8);
  row.put(strip.frame_key, 64);
  row.put(strip.exposure_count, 48);
  row.put(static_cast<std::uint64_t>(strip.state.board), 16);
  row.put(row.check_sum(row.place()), 64);
  const auto white = static_cast<std::uint16_t>((1u << bits) - 1u);
  for (std::size_t i = 0; i < kStateStripPixels; ++i) samples[i] = row.bits()[i] ? white : std::uint16_t{0};
}

std::optional<StateStrip> read_state_strip(std::span<const std::uint16_t> samples, int bits) {
  if (samples.size() < kStateStripPixels) return {};
  BitRow row;
  for (std::size_t i = 0; i < kStateStripPixels; ++i) row.bits()[i] = samples[i] >> (bits - 1);
  if (row.take(16) != kMark) return {};
  StateStrip strip;
  strip.settings.exposure_s = static_cast<double>(row.take(64)) / 1e9;
  strip.settings.gain_db = from_thousandths(row.take(32));
  strip.state.turntable_deg = from_thousandths(row.take(32));
  strip.state.light_azimuth_deg = from_thousandths(row.take(32));
  strip.state.light_elevation_deg = from_thousandths(row.take(32));
  const std::uint64_t lamps = row.take(8);
  strip.state.point_light = lamps & 1u;
  strip.state.ring_flash = lamps & 2u;
  strip.state.backlight = lamps & 4u;
  strip.frame_key = row.take(64);
  strip.state.flat_field = lamps & 8u;
  strip.exposure_count = row.take(48);
  strip.state.board = static_cast<int>(row.take(16));
  const std::uint64_t sum = row.check_sum(row.place());
  if (row.take(64) != sum) return {};
  return strip;
}

}  // namespace lumitexel
