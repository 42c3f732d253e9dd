// Camera raw files (CR2, CR3, NEF, ARW, DNG, …) as the sensor's integers and what their EXIF says. LibRaw reads them;
// nothing is subtracted, scaled, turned or interpolated.
//
// The samples are those of the visible area: the masked border that many sensors have is left out, and the mosaic is
// that of the visible area's corner. Sizes are therefore LibRaw's, which may differ by some pixels from what a maker
// advertises. Tried: DNGs of our own simulated camera only. Real cameras' files: not yet.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "drivers/camera.h"

namespace lumitexel {

// What the file says about itself; empty where it does not.
struct CameraRawExif {
  std::optional<double> exposure_s, iso;
  std::string artist, copyright;
  // DateTimeOriginal as seconds since 1970-01-01, as if the camera's clock kept UTC: EXIF mostly names no zone.
  std::optional<double> time_s;
  bool has_subseconds = false;                // else time_s is whole
  std::optional<std::uint64_t> image_number;  // EXIF's ImageNumber, not what makers count in their own tags
  std::optional<double> temperature_c;        // of the sensor, else of the camera, else of the air
};

struct CameraRaw {
  int width_px = 0, height_px = 0;
  int bits = 16;  // of the white level; no sample lies above 2^bits - 1
  Mosaic mosaic = Mosaic::Mono;
  std::vector<std::uint16_t> samples;  // row-major, width_px * height_px
  CameraRawExif exif;
};

// where: names the file in errors. Throws Corrupt, naming it, for bytes that are no camera raw file, end too early, or
// hold something else than a monochrome or a 2x2 Bayer mosaic. Thread-safe.
CameraRaw decode_camera_raw(std::span<const std::uint8_t> bytes, const std::string& where);

}  // namespace lumitexel
