// The simulated camera's raw file: an uncompressed DNG 1.4 of 16-bit samples, Bayer or monochrome, with EXIF.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "drivers/camera.h"

namespace lumitexel::ptp {

struct DngContent {
  int width_px = 0, height_px = 0, bits = 16;
  Mosaic mosaic = Mosaic::Mono;
  std::span<const std::uint16_t> samples;  // row-major, width_px * height_px, all of the raw area; nothing is masked
  double black_level_dn = 0;
  // EXIF
  double exposure_s = 0;
  int iso = 100;
  double f_number = 8.0;
  std::string make, model;  // readers recognise a raw file by them: neither may be empty
  std::string serial;
  std::string artist;       // empty: left out
  std::int64_t utc_ns = 0;  // the camera's clock is set to UTC; written to the microsecond
  std::uint32_t image_number = 0;
  double temperature_c = 25;  // as EXIF's AmbientTemperature: it has no tag for the sensor's
};

// The file's bytes. Throws OutOfRange if samples and size disagree, the size is none or no maker is named.
std::vector<std::uint8_t> write_dng(const DngContent& content);

}  // namespace lumitexel::ptp
