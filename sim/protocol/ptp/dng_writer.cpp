#include "sim/protocol/ptp/dng_writer.h"

#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "drivers/error.h"
#include "sim/protocol/ptp/dataset.h"
#include "sim/protocol/ptp/tiff_directory.h"

namespace lumitexel::ptp {
namespace {

constexpr std::uint32_t kFirstDirectory = 8;
constexpr std::uint16_t kCfa = 32803, kLinearRaw = 34892;  // PhotometricInterpretation

std::string date_text(std::int64_t utc_ns) {
  using namespace std::chrono;
  const sys_seconds second(floor<seconds>(nanoseconds(utc_ns)));
  const sys_days day(floor<days>(second));
  const year_month_day date(day);
  const hh_mm_ss time(second - day);
  std::array<char, 64> text;
  std::snprintf(text.data(), text.size(), "%04d:%02u:%02u %02d:%02d:%02d", static_cast<int>(date.year()),
                static_cast<unsigned>(date.month()), static_cast<unsigned>(date.day()),
                static_cast<int>(time.hours().count()), static_cast<int>(time.minutes().count()),
                static_cast<int>(time.seconds().count()));
  return text.data();
}

std::string subsecond_text(std::int64_t utc_ns) {
  const std::int64_t rest_ns = ((utc_ns % 1'000'000'000) + 1'000'000'000) % 1'000'000'000;
  std::array<char, 32> text;
  std::snprintf(text.data(), text.size(), "%06d", static_cast<int>(rest_ns / 1000));
  return text.data();
}

// 0 red, 1 green, 2 blue, of the pixels (0,0) (1,0) / (0,1) (1,1).
std::vector<std::uint8_t> pattern_of(Mosaic mosaic) {
  switch (mosaic) {
    case Mosaic::Rggb:
      return {0, 1, 1, 2};
    case Mosaic::Bggr:
      return {2, 1, 1, 0};
    case Mosaic::Grbg:
      return {1, 0, 2, 1};
    default:
      return {1, 2, 0, 1};
  }
}

void add_mosaic(TiffDirectory& directory, Mosaic mosaic) {
  directory.shorts(262, {mosaic == Mosaic::Mono ? kLinearRaw : kCfa});
  if (mosaic == Mosaic::Mono) return;
  directory.shorts(33421, {2, 2});             // CFARepeatPatternDim
  directory.bytes(33422, pattern_of(mosaic));  // CFAPattern
  directory.bytes(50710, {0, 1, 2});           // CFAPlaneColor
  directory.shorts(50711, {1});                // CFALayout: rectangular
  const Rational one{1, 1}, zero{0, 1};
  directory.rationals(50721, {one, zero, zero, zero, one, zero, zero, zero, one}, true);  // ColorMatrix1
  directory.rationals(50728, {one, one, one}, false);                                     // AsShotNeutral
  directory.shorts(50778, {21});                                                          // D65
}

void add_picture(TiffDirectory& directory, const DngContent& content) {
  directory.long_number(254, 0);  // the full picture
  directory.long_number(256, static_cast<std::uint32_t>(content.width_px));
  directory.long_number(257, static_cast<std::uint32_t>(content.height_px));
  directory.shorts(258, {16});
  directory.shorts(259, {1});  // not compressed
  directory.shorts(274, {1});  // upright
  directory.shorts(277, {1});
  directory.long_number(278, static_cast<std::uint32_t>(content.height_px));  // a single strip
  directory.long_number(279, static_cast<std::uint32_t>(2 * content.samples.size()));
  directory.shorts(284, {1});
  directory.bytes(50706, {1, 4, 0, 0});  // DNGVersion
  directory.bytes(50707, {1, 1, 0, 0});  // DNGBackwardVersion
  directory.rationals(50714, {unsigned_rational(content.black_level_dn)}, false);
  directory.long_number(50717, (1u << content.bits) - 1u);  // WhiteLevel
  add_mosaic(directory, content.mosaic);
}

void add_origin(TiffDirectory& directory, const DngContent& content) {
  directory.text(271, content.make);
  directory.text(272, content.model);
  directory.text(306, date_text(content.utc_ns));
  if (!content.artist.empty()) directory.text(315, content.artist);
  directory.long_number(37393, content.image_number);
  directory.text(50708, content.make + " " + content.model);  // UniqueCameraModel
  directory.text(50735, content.serial);
}

TiffDirectory exif_of(const DngContent& content) {
  TiffDirectory exif;
  exif.rationals(33434, {unsigned_rational(content.exposure_s)}, false);
  exif.rationals(33437, {unsigned_rational(content.f_number)}, false);
  exif.shorts(34855, {static_cast<std::uint16_t>(content.iso)});
  exif.raw_text(36864, "0231");
  for (const std::uint16_t tag : {36867, 36868}) exif.text(tag, date_text(content.utc_ns));
  for (const std::uint16_t tag : {37520, 37521, 37522}) exif.text(tag, subsecond_text(content.utc_ns));
  exif.rationals(37888, {{std::llround(100.0 * content.temperature_c), 100}}, true);
  exif.text(42033, content.serial);
  return exif;
}

void require_usable(const DngContent& content) {
  const std::size_t pixels = static_cast<std::size_t>(content.width_px) * static_cast<std::size_t>(content.height_px);
  if (content.width_px > 0 && content.height_px > 0 && content.samples.size() == pixels && content.bits >= 1 &&
      content.bits <= 16 && content.iso > 0 && content.iso < 65536 && !content.make.empty() && !content.model.empty()) {
    return;
  }
  throw OutOfRange("DNG: " + std::to_string(content.width_px) + " x " + std::to_string(content.height_px) +
                   " pixels of " + std::to_string(content.bits) + " bits by '" + content.make + "', '" + content.model +
                   "', ISO " + std::to_string(content.iso) + ", " + std::to_string(content.samples.size()) +
                   " samples given");
}

}  // namespace

std::vector<std::uint8_t> write_dng(const DngContent& content) {
  require_usable(content);
  TiffDirectory picture;
  const TiffDirectory exif = exif_of(content);
  add_picture(picture, content);
  add_origin(picture, content);
  picture.long_number(273, 0);    // where the strip is, and
  picture.long_number(34665, 0);  // where the EXIF directory: known once their places' own entries are counted
  const auto exif_at = static_cast<std::uint32_t>(kFirstDirectory + picture.size());
  const auto strip_at = static_cast<std::uint32_t>(exif_at + exif.size());
  picture.long_number(273, strip_at);
  picture.long_number(34665, exif_at);

  DatasetWriter file;
  file.u8('I').u8('I').u16(42).u32(kFirstDirectory);
  file.bytes(picture.encoded(kFirstDirectory)).bytes(exif.encoded(exif_at));
  std::vector<std::uint8_t> bytes = file.take();
  std::size_t place = bytes.size();
  bytes.resize(place + 2 * content.samples.size());
  for (const std::uint16_t sample : content.samples) {
    bytes[place++] = static_cast<std::uint8_t>(sample);
    bytes[place++] = static_cast<std::uint8_t>(sample >> 8);
  }
  return bytes;
}

}  // namespace lumitexel::ptp
