#include "drivers/gphoto/camera_raw.h"

#include <libraw/libraw.h>

#include <algorithm>
#include <bit>
#include <memory>

#include "drivers/error.h"
#include "drivers/gphoto/exif_tags.h"

namespace lumitexel {
namespace {

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw Corrupt(where + ": no usable camera raw file: " + what);
}

void require(int libraw_code, const std::string& where) {
  if (libraw_code != LIBRAW_SUCCESS) fail(where, libraw_strerror(libraw_code));
}

// LibRaw's own stream counts an item of which only a part is left as read.
class StrictStream final : public LibRaw_buffer_datastream {
 public:
  explicit StrictStream(std::span<const std::uint8_t> bytes)  // which are not written to
      : LibRaw_buffer_datastream(const_cast<std::uint8_t*>(bytes.data()), bytes.size()) {}
  int read(void* into, std::size_t size, std::size_t count) override {
    const INT64 start = tell();
    LibRaw_buffer_datastream::read(into, size, count);
    return size == 0 ? 0 : static_cast<int>(static_cast<std::size_t>(tell() - start) / size);
  }
};

void take_tag(void* tags, int tag, int type, int count, unsigned order, void* stream, INT64) {
  auto* file = static_cast<LibRaw_abstract_datastream*>(stream);
  static_cast<ExifTags*>(tags)->take(tag, type, count, order == 0x4949, [file](std::span<std::uint8_t> into) {
    return file->read(into.data(), 1, into.size()) == static_cast<int>(into.size());
  });
}

// Called where a decoder finds the picture's data damaged or ending early; LibRaw's own would write to stderr.
void note_data_error(void* noted, const char*, int) { *static_cast<bool*>(noted) = true; }

Mosaic mosaic_of(LibRaw& raw, const std::string& where) {
  if (raw.imgdata.idata.filters == 0 && raw.imgdata.idata.colors == 1) return Mosaic::Mono;
  std::string pattern;
  for (const int y : {0, 1}) {
    for (const int x : {0, 1}) {
      const int colour = raw.COLOR(y, x);
      pattern += colour >= 0 && colour < 4 ? raw.imgdata.idata.cdesc[colour] : '?';
    }
  }
  // Smaller numbers stand for patterns that are not 2x2.
  if (raw.imgdata.idata.filters >= 1000) {
    if (pattern == "RGGB") return Mosaic::Rggb;
    if (pattern == "BGGR") return Mosaic::Bggr;
    if (pattern == "GRBG") return Mosaic::Grbg;
    if (pattern == "GBRG") return Mosaic::Gbrg;
  }
  fail(where, "its mosaic is '" + pattern + "', neither monochrome nor 2x2 Bayer");
}

void copy_visible(const LibRaw& raw, CameraRaw& out, const std::string& where) {
  const libraw_image_sizes_t& sizes = raw.imgdata.sizes;
  const std::uint16_t* all = raw.imgdata.rawdata.raw_image;
  if (all == nullptr) fail(where, "its pixels are not a mosaic's");
  if (sizes.width == 0 || sizes.height == 0 || sizes.left_margin + sizes.width > sizes.raw_width ||
      sizes.top_margin + sizes.height > sizes.raw_height || sizes.raw_pitch < 2u * sizes.raw_width) {
    fail(where, "its visible area does not lie within its pixels");
  }
  out.width_px = sizes.width;
  out.height_px = sizes.height;
  out.samples.reserve(static_cast<std::size_t>(sizes.width) * sizes.height);
  for (std::size_t y = 0; y < sizes.height; ++y) {
    const std::uint16_t* row = all + (y + sizes.top_margin) * (sizes.raw_pitch / 2) + sizes.left_margin;
    out.samples.insert(out.samples.end(), row, row + sizes.width);
  }
}

int bits_of(const LibRaw& raw, const std::vector<std::uint16_t>& samples, const std::string& where) {
  const int bits = static_cast<int>(std::bit_width(raw.imgdata.color.maximum));
  const int needed = static_cast<int>(std::bit_width(unsigned{*std::max_element(samples.begin(), samples.end())}));
  if (bits < 1 || bits > 16 || needed > bits) {
    fail(where, "samples of " + std::to_string(needed) + " bits under a white level of " +
                    std::to_string(raw.imgdata.color.maximum));
  }
  return bits;
}

CameraRawExif exif_of(const LibRaw& raw, const ExifTags& tags) {
  CameraRawExif exif;
  const libraw_imgother_t& other = raw.imgdata.other;
  if (other.shutter > 0.0f) exif.exposure_s = other.shutter;
  if (other.iso_speed > 0.0f) exif.iso = other.iso_speed;
  exif.artist.assign(other.artist, std::find(other.artist, other.artist + sizeof other.artist, '\0'));
  const libraw_metadata_common_t& common = raw.imgdata.makernotes.common;
  for (const float celsius : {common.SensorTemperature, common.CameraTemperature, common.exifAmbientTemperature}) {
    // LibRaw's mark for "not known" is -1000.
    if (!exif.temperature_c && celsius > -273.0f && celsius < 1000.0f) exif.temperature_c = celsius;
  }
  tags.complete(exif);
  return exif;
}

}  // namespace

CameraRaw decode_camera_raw(std::span<const std::uint8_t> bytes, const std::string& where) {
  if (bytes.empty()) fail(where, "it is empty");
  StrictStream stream(bytes);
  const auto raw = std::make_unique<LibRaw>();  // some hundred kilobytes
  ExifTags tags;
  bool data_error = false;
  raw->set_exifparser_handler(take_tag, &tags);
  raw->set_dataerror_handler(note_data_error, &data_error);
  require(raw->open_datastream(&stream), where);
  require(raw->unpack(), where);
  if (data_error) fail(where, "its data end too early");
  CameraRaw out;
  copy_visible(*raw, out, where);
  out.mosaic = mosaic_of(*raw, where);
  out.bits = bits_of(*raw, out.samples, where);
  out.exif = exif_of(*raw, tags);
  return out;
}

}  // namespace lumitexel
