// Sensor integers as a file: binary PGM (P5), 16 bits big-endian (8 bits when maxval < 256), with the maxval of
// the sensor's bit depth. The mosaic is a comment line. Any image tool opens it.
#pragma once

#include <string>
#include <string_view>

#include "drivers/camera.h"

namespace lumitexel {

std::string encode_pgm(const Frame& frame);
// width_px, height_px, bits, mosaic and samples are filled. Throws Corrupt naming `where` for anything truncated or malformed.
Frame decode_pgm(std::string_view bytes, const std::string& where);

}  // namespace lumitexel
