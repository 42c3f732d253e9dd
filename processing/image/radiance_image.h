// A calibrated photograph: linear scene radiance with the variance of every value and a flag per pixel.
#pragma once

#include <cstdint>
#include <filesystem>
#include <vector>

#include "processing/image/image.h"

namespace lumitexel {

// Bits of RadianceImage::flags.
enum PixelFlag : std::uint8_t {
  kPixelSaturated = 1,  // clipped even in the shortest exposure
  kPixelDark = 2,       // below the noise floor even in the longest exposure (a value is still given)
  kPixelDefective = 4,  // hot or dead, or not finite
  kPixelOutside = 8,    // outside the object's mask, where the session has masks
};

// Pixels that are no samples of the object. Dark ones are: their value and variance are right, and to leave out those that noise
// happened to push below the floor would make dark surfaces too bright.
inline constexpr std::uint8_t kUnusablePixel = kPixelSaturated | kPixelDefective | kPixelOutside;

struct RadianceImage {
  Image radiance;                    // one consistent unit per session, proportional to W/(m^2 sr)
  Image variance;                    // of each radiance value, same shape; 0 where unknown (imported photographs)
  std::vector<std::uint8_t> flags;   // width * height, PixelFlag bits
  std::uint8_t flag(int x, int y) const {
    return flags[static_cast<std::size_t>(y) * static_cast<std::size_t>(radiance.width) + static_cast<std::size_t>(x)];
  }
};

// One EXR with channels R,G,B (or Y for one channel), variance.R,… (or variance.Y) as 32-bit float and flags as uint.
// Throws Error if it cannot be written; reading throws Corrupt naming the file.
void write_radiance_image(const std::filesystem::path& path, const RadianceImage& image);
RadianceImage read_radiance_image(const std::filesystem::path& path);

}  // namespace lumitexel
