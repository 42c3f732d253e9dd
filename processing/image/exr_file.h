// OpenEXR files as named planes of float.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "processing/image/image.h"

namespace lumitexel {

enum class ExrPixel { Half, Float, Uint };  // how a plane is stored; in memory all are float

struct ExrPlane {
  std::string name;  // "R", "variance.G", "weight3"
  ExrPixel stored = ExrPixel::Float;
  std::vector<float> data;  // row-major, width * height
};

struct ExrImage {
  int width = 0, height = 0;
  std::vector<ExrPlane> planes;
};

// Throws BadInput naming the file if it is missing, truncated or not an EXR.
ExrImage read_exr(const std::filesystem::path& path);
// Written under a temporary name and renamed, so a reader never meets half a file. Throws Error.
void write_exr(const std::filesystem::path& path, const ExrImage& image);

// The colour planes in the order R, G, B (or Y alone) as one image; other planes are ignored.
// Throws BadInput naming the file if there are neither.
Image read_exr_colour(const std::filesystem::path& path);
// Channels named R,G,B for three, Y for one.
void write_exr_colour(const std::filesystem::path& path, const Image& image, ExrPixel stored = ExrPixel::Float);

// {"R","G","B"} for three channels, {"Y"} for one.
std::vector<std::string> colour_channel_names(int channels);

}  // namespace lumitexel
