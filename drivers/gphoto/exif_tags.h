// The EXIF tags that LibRaw does not keep, or keeps in less precision than the file has: taken while it reads.
#pragma once

#include <cstdint>
#include <functional>
#include <span>

#include "drivers/gphoto/camera_raw.h"

namespace lumitexel {

class ExifTags {
 public:
  // Reads so many bytes of the tag's value; false if the file ends first.
  using Read = std::function<bool(std::span<std::uint8_t>)>;

  // tag: LibRaw's, in bits 16 and up whose directory's it is. type, count: TIFF's.
  void take(int tag, int type, int count, bool little_endian, const Read& read);
  // Puts them where `exif` has nothing better.
  void complete(CameraRawExif& exif) const;

 private:
  std::optional<double> exposure_s_, iso_, image_number_;
  std::string artist_, copyright_, date_, subseconds_;
};

}  // namespace lumitexel
