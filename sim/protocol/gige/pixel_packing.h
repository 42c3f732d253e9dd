// How sensor integers lie in a frame's bytes, by GenICam's pixel formats.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/camera.h"

namespace lumitexel::gige {

enum class Packing {
  OneByte,
  TwoBytes,       // low byte first
  ThreeForTwo,    // "Packed": high 8 bits of a, low 4 of a and (above) of b, high 8 bits of b
  ThreeForTwoLsb  // "p": one stream of bits, lowest first
};

struct PixelFormat {
  std::string name;
  std::uint32_t code = 0;  // its bits 16 to 23 are the bits a pixel takes
  int bits = 0;
  Packing packing = Packing::OneByte;
};

// Those that hold samples of so many bits as they are: nothing is shifted or cut.
std::vector<PixelFormat> pixel_formats(Mosaic mosaic, int bits);

std::size_t packed_bytes(const PixelFormat& format, std::size_t pixels);
std::vector<std::uint8_t> packed(const PixelFormat& format, std::span<const std::uint16_t> samples);

}  // namespace lumitexel::gige
