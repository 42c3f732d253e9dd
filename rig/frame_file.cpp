#include "rig/frame_file.h"

#include <filesystem>
#include <span>

#include "drivers/gphoto/camera_raw.h"
#include "rig/raw_frame_file.h"

namespace lumitexel {

std::string stored_name(const Shot& shot, const Frame& frame) {
  if (frame.camera_file.empty()) return frame_file_name(shot);
  return std::filesystem::path(frame_file_name(shot)).replace_extension(frame.camera_file_extension).string();
}

std::string stored_bytes(const Frame& frame) {
  if (frame.camera_file.empty()) return encode_pgm(frame);
  return {frame.camera_file.begin(), frame.camera_file.end()};
}

Frame decode_frame_file(std::string_view bytes, const std::string& where) {
  const std::string extension = std::filesystem::path(where).extension().string();
  if (extension == ".pgm") return decode_pgm(bytes, where);
  const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
  CameraRaw raw = decode_camera_raw(std::span(first, bytes.size()), where);
  Frame frame;
  frame.width_px = raw.width_px;
  frame.height_px = raw.height_px;
  frame.bits = raw.bits;
  frame.mosaic = raw.mosaic;
  frame.samples = std::move(raw.samples);
  frame.camera_file.assign(first, first + bytes.size());
  frame.camera_file_extension = extension.empty() ? extension : extension.substr(1);
  return frame;
}

}  // namespace lumitexel
