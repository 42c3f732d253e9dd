// A stored frame: the sensor's integers as PGM (rig/raw_frame_file.h), or the camera's own raw file, byte for byte.
#pragma once

#include <string>
#include <string_view>

#include "drivers/camera.h"
#include "rig/shot.h"

namespace lumitexel {

// The name inside frames/: frame_file_name(shot), with the camera file's extension where the frame has one.
std::string stored_name(const Shot& shot, const Frame& frame);
// Throws Protocol as encode_pgm does.
std::string stored_bytes(const Frame& frame);

// The format is the name's extension: .pgm, or a camera raw file's. width_px, height_px, bits, mosaic and samples are filled,
// and camera_file for raw files. Throws Corrupt naming `where`.
Frame decode_frame_file(std::string_view bytes, const std::string& where);

}  // namespace lumitexel
