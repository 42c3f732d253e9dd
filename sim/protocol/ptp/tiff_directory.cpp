#include "sim/protocol/ptp/tiff_directory.h"

#include <cmath>
#include <limits>

#include "drivers/error.h"
#include "sim/protocol/ptp/dataset.h"

namespace lumitexel::ptp {
namespace {

constexpr std::uint16_t kByte = 1, kAscii = 2, kShort = 3, kLong = 4, kRational = 5, kUndefined = 7,
                        kSignedRational = 10;

std::size_t even(std::size_t size) { return size + size % 2; }

std::vector<std::uint8_t> characters(const std::string& text) { return {text.begin(), text.end()}; }

}  // namespace

Rational unsigned_rational(double value) {
  constexpr double kMost = std::numeric_limits<std::uint32_t>::max();
  if (!(value >= 0.0 && value <= kMost)) throw OutOfRange("TIFF rational: " + std::to_string(value));
  // A camera's exposures are whole tenths of milliseconds most often.
  const double tenths = std::round(value * 1e4);
  if (tenths <= kMost && std::abs(tenths - value * 1e4) <= 1e-12 * tenths) {
    return {static_cast<std::int64_t>(tenths), 10'000};
  }
  std::int64_t denominator = 1'000'000'000;
  while (denominator > 1 && value * static_cast<double>(denominator) > kMost) denominator /= 10;
  return {std::llround(value * static_cast<double>(denominator)), denominator};
}

void TiffDirectory::bytes(std::uint16_t tag, const std::vector<std::uint8_t>& values) {
  entries_[tag] = {kByte, static_cast<std::uint32_t>(values.size()), values};
}

void TiffDirectory::text(std::uint16_t tag, const std::string& text) {
  std::vector<std::uint8_t> value = characters(text);
  value.push_back(0);
  entries_[tag] = {kAscii, static_cast<std::uint32_t>(value.size()), value};
}

void TiffDirectory::raw_text(std::uint16_t tag, const std::string& text) {
  entries_[tag] = {kUndefined, static_cast<std::uint32_t>(text.size()), characters(text)};
}

void TiffDirectory::shorts(std::uint16_t tag, const std::vector<std::uint16_t>& values) {
  DatasetWriter writer;
  for (const std::uint16_t value : values) writer.u16(value);
  entries_[tag] = {kShort, static_cast<std::uint32_t>(values.size()), writer.take()};
}

void TiffDirectory::long_number(std::uint16_t tag, std::uint32_t value) {
  entries_[tag] = {kLong, 1, DatasetWriter().u32(value).take()};
}

void TiffDirectory::rationals(std::uint16_t tag, const std::vector<Rational>& values, bool with_sign) {
  DatasetWriter writer;
  for (const Rational& value : values) {
    writer.u32(static_cast<std::uint32_t>(value.numerator)).u32(static_cast<std::uint32_t>(value.denominator));
  }
  entries_[tag] = {with_sign ? kSignedRational : kRational, static_cast<std::uint32_t>(values.size()), writer.take()};
}

std::size_t TiffDirectory::size() const {
  std::size_t size = 2 + 12 * entries_.size() + 4;
  for (const auto& [tag, entry] : entries_) size += entry.value.size() > 4 ? even(entry.value.size()) : 0;
  return size;
}

std::vector<std::uint8_t> TiffDirectory::encoded(std::uint32_t offset) const {
  DatasetWriter head, behind;
  const std::size_t values_at = offset + 2 + 12 * entries_.size() + 4;
  head.u16(entries_.size());
  for (const auto& [tag, entry] : entries_) {
    head.u16(tag).u16(entry.type).u32(entry.count);
    if (entry.value.size() <= 4) {
      head.bytes(entry.value).number(0, static_cast<int>(4 - entry.value.size()));
    } else {
      head.u32(values_at + behind.data().size());
      behind.bytes(entry.value).number(0, static_cast<int>(entry.value.size() % 2));
    }
  }
  head.u32(0);  // no further directory
  head.bytes(behind.data());
  return head.take();
}

}  // namespace lumitexel::ptp
