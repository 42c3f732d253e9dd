// 8- and 16-bit PNG and TIFF, as they are: code values, no colour management.
#pragma once

#include <filesystem>
#include <string>

#include "processing/image/image.h"

namespace lumitexel {

struct RasterImage {
  Image code_values;  // 0 … maximum, channels in the order R, G, B (or one)
  float maximum = 255.0f;
};

// Throws BadInput naming the file if it is missing, truncated or neither PNG nor TIFF. An alpha channel is dropped.
RasterImage read_raster(const std::filesystem::path& path);
// Values in [0, 1] as 8-bit PNG, clipped; NaN becomes 0. One or three channels, or four, the last alpha. Throws Error.
void write_png8(const std::filesystem::path& path, const Image& unit_values);
// The same PNG as bytes, for embedding in a page.
std::string encode_png8(const Image& unit_values);

}  // namespace lumitexel
