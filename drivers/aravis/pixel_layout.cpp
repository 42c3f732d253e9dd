#include "drivers/aravis/pixel_layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cstring>
#include <utility>

namespace lumitexel {
namespace {

constexpr std::array<std::pair<const char*, Mosaic>, 5> kStems{{{"Mono", Mosaic::Mono},
                                                                {"BayerRG", Mosaic::Rggb},
                                                                {"BayerBG", Mosaic::Bggr},
                                                                {"BayerGR", Mosaic::Grbg},
                                                                {"BayerGB", Mosaic::Gbrg}}};

struct Depth {
  const char* suffix;
  int bits;
  PixelPacking packing;
};

// In the order of preference: no more bits than needed; among equals what needs no unpacking.
constexpr std::array<Depth, 7> kDepths{{{"8", 8, PixelPacking::OneByte},
                                        {"10", 10, PixelPacking::TwoBytes},
                                        {"12", 12, PixelPacking::TwoBytes},
                                        {"12Packed", 12, PixelPacking::ThreeForTwo},
                                        {"12p", 12, PixelPacking::ThreeForTwoLsb},
                                        {"14", 14, PixelPacking::TwoBytes},
                                        {"16", 16, PixelPacking::TwoBytes}}};

std::pair<unsigned, unsigned> unpacked(PixelPacking packing, unsigned first, unsigned middle, unsigned last) {
  if (packing == PixelPacking::ThreeForTwo) return {first << 4 | (middle & 0xf), last << 4 | middle >> 4};
  return {(middle & 0xf) << 8 | first, last << 4 | middle >> 4};
}

}  // namespace

std::size_t PixelLayout::bytes(std::size_t pixels) const {
  switch (packing) {
    case PixelPacking::OneByte: return pixels;
    case PixelPacking::TwoBytes: return 2 * pixels;
    default: return (pixels + 1) / 2 * 3;
  }
}

std::optional<PixelLayout> pixel_layout(const std::string& name) {
  for (const auto& [stem, mosaic] : kStems) {
    for (const Depth& depth : kDepths) {
      if (name == std::string(stem) + depth.suffix) return PixelLayout{name, mosaic, depth.bits, depth.packing};
    }
  }
  return {};
}

std::optional<PixelLayout> suitable_layout(Mosaic mosaic, int bits, const std::vector<std::string>& offered) {
  for (const auto& [stem, colours] : kStems) {
    if (colours != mosaic) continue;
    for (const Depth& depth : kDepths) {
      const std::string name = std::string(stem) + depth.suffix;
      if (depth.bits >= bits && std::find(offered.begin(), offered.end(), name) != offered.end()) {
        return pixel_layout(name);
      }
    }
  }
  return {};
}

std::vector<std::uint16_t> decoded(const PixelLayout& layout, std::span<const std::uint8_t> bytes, std::size_t pixels) {
  std::vector<std::uint16_t> samples(pixels);
  if (layout.packing == PixelPacking::OneByte) {
    std::copy_n(bytes.begin(), pixels, samples.begin());
  } else if (layout.packing == PixelPacking::TwoBytes && std::endian::native == std::endian::little) {
    std::memcpy(samples.data(), bytes.data(), 2 * pixels);
  } else if (layout.packing == PixelPacking::TwoBytes) {
    for (std::size_t i = 0; i < pixels; ++i) {
      samples[i] = static_cast<std::uint16_t>(bytes[2 * i] | bytes[2 * i + 1] << 8);
    }
  } else {
    for (std::size_t i = 0; i < pixels; i += 2) {
      const std::uint8_t* three = bytes.data() + i / 2 * 3;
      const auto [a, b] = unpacked(layout.packing, three[0], three[1], three[2]);
      samples[i] = static_cast<std::uint16_t>(a);
      if (i + 1 < pixels) samples[i + 1] = static_cast<std::uint16_t>(b);
    }
  }
  return samples;
}

}  // namespace lumitexel
