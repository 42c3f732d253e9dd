// Sensor integers as a file: binary PGM (P5), 16 bits big-endian (8 bits when maxval < 256), with the maxval of
// the sensor's bit depth. The mosaic is a comment line. Any image tool opens it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "drivers/camera.h"

namespace lumitexel {

// Throws Protocol if the frame's samples are not width_px * height_px of at most `bits` bits.
std::string encode_pgm(const Frame& frame);
// The size of every file that encode_pgm makes of this camera's frames.
std::int64_t pgm_bytes(const CameraLimits& limits);
// width_px, height_px, bits, mosaic and samples are filled. Throws Corrupt naming `where` for anything truncated or malformed.
Frame decode_pgm(std::string_view bytes, const std::string& where);

}  // namespace lumitexel
