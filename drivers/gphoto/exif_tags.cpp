#include "drivers/gphoto/exif_tags.h"

#include <chrono>
#include <cstdio>
#include <vector>

namespace lumitexel {
namespace {

constexpr int kAscii = 2, kShort = 3, kLong = 4, kRational = 5;
constexpr int kLongestText = 256;

std::uint32_t number(std::span<const std::uint8_t> bytes, bool little_endian) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    value |= std::uint32_t{bytes[little_endian ? i : bytes.size() - 1 - i]} << (8 * i);
  }
  return value;
}

std::string text_value(int type, int count, const ExifTags::Read& read) {
  if (type != kAscii || count <= 0 || count > kLongestText) return {};
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(count));
  if (!read(bytes)) return {};
  std::string text(bytes.begin(), bytes.end());
  return text.substr(0, text.find('\0'));
}

// Empty as well for 0 and for 1/0.
std::optional<double> positive_value(int type, int count, bool little_endian, const ExifTags::Read& read) {
  std::vector<std::uint8_t> bytes(type == kShort ? 2 : type == kLong ? 4 : type == kRational ? 8 : 0);
  if (bytes.empty() || count < 1 || !read(bytes)) return {};
  const std::span<const std::uint8_t> all(bytes);
  double value = number(all.first(std::min<std::size_t>(4, all.size())), little_endian);
  if (type == kRational) {
    const double denominator = number(all.last(4), little_endian);
    if (denominator == 0.0) return {};
    value /= denominator;
  }
  return value > 0.0 ? std::optional(value) : std::nullopt;
}

// "2026:01:31 12:00:00"; empty for blanks, zeros and other nonsense that cameras without a set clock write.
std::optional<double> seconds_of(const std::string& date) {
  int years = 0;
  unsigned months = 0, days = 0, hours = 0, minutes = 0, seconds = 0;
  if (std::sscanf(date.c_str(), "%4d:%2u:%2u %2u:%2u:%2u", &years, &months, &days, &hours, &minutes, &seconds) != 6) {
    return {};
  }
  using namespace std::chrono;
  const year_month_day calendar{year(years), month(months), day(days)};
  if (!calendar.ok() || hours > 23 || minutes > 59 || seconds > 60) return {};
  return static_cast<double>(sys_days(calendar).time_since_epoch().count()) * 86400.0 + hours * 3600.0 +
         minutes * 60.0 + seconds;
}

std::optional<double> fraction_of(const std::string& digits) {
  double fraction = 0.0, place = 0.1;
  for (const char digit : digits) {
    if (digit == ' ') break;
    if (digit < '0' || digit > '9') return {};
    fraction += place * (digit - '0');
    place *= 0.1;
  }
  return digits.empty() || digits.front() == ' ' ? std::nullopt : std::optional(fraction);
}

template <class Value>
void keep_first(Value& kept, Value value) {
  if (kept == Value{}) kept = std::move(value);
}

}  // namespace

void ExifTags::take(int tag, int type, int count, bool little_endian, const Read& read) {
  if ((tag >> 16 & 0xF) != 0) return;  // a maker's own directory: the same numbers mean other things there
  switch (tag & 0xFFFF) {
    case 33434:
      return keep_first(exposure_s_, positive_value(type, count, little_endian, read));
    case 34855:
      return keep_first(iso_, positive_value(type, count, little_endian, read));
    case 37393:
      return keep_first(image_number_, positive_value(type, count, little_endian, read));
    case 315:
      return keep_first(artist_, text_value(type, count, read));
    case 33432:
      return keep_first(copyright_, text_value(type, count, read));
    case 36867:
      return keep_first(date_, text_value(type, count, read));
    case 37521:
      return keep_first(subseconds_, text_value(type, count, read));
    default:
      return;
  }
}

void ExifTags::complete(CameraRawExif& exif) const {
  if (exposure_s_) exif.exposure_s = exposure_s_;
  if (iso_ && *iso_ < 65535.0) exif.iso = iso_;  // 65535: too large for the tag, said elsewhere
  if (!artist_.empty()) exif.artist = artist_;
  exif.copyright = copyright_;
  if (image_number_) exif.image_number = static_cast<std::uint64_t>(*image_number_);
  const std::optional<double> time_s = seconds_of(date_);
  if (!time_s) return;
  const std::optional<double> fraction = fraction_of(subseconds_);
  exif.time_s = *time_s + fraction.value_or(0.0);
  exif.has_subseconds = fraction.has_value();
}

}  // namespace lumitexel
