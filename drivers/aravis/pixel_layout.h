// How a camera's bytes become sensor integers, by GenICam's pixel format names.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/camera.h"

namespace lumitexel {

enum class PixelPacking { OneByte, TwoBytes, ThreeForTwo, ThreeForTwoLsb };

struct PixelLayout {
  std::string name;  // "Mono12Packed"
  Mosaic mosaic = Mosaic::Mono;
  int bits = 0;  // that the layout can hold
  PixelPacking packing = PixelPacking::OneByte;

  std::size_t bytes(std::size_t pixels) const;
};

// Mono and Bayer formats of 8, 10, 12, 14, 16 bits, the 12 also "Packed" and "p"; empty for any other name.
std::optional<PixelLayout> pixel_layout(const std::string& name);

// The first of the layouts that hold such samples, the shortest first, that the camera offers; empty if it offers none.
std::optional<PixelLayout> suitable_layout(Mosaic mosaic, int bits, const std::vector<std::string>& offered);

// Exactly `pixels` samples of bytes.size() >= layout.bytes(pixels); two-byte samples are low byte first.
std::vector<std::uint16_t> decoded(const PixelLayout& layout, std::span<const std::uint8_t> bytes, std::size_t pixels);

}  // namespace lumitexel
