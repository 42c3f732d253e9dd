#include "sim/protocol/ptp/dataset.h"

#include <algorithm>

#include "drivers/error.h"

namespace lumitexel::ptp {

DatasetWriter& DatasetWriter::number(std::uint64_t value, int bytes) {
  for (int i = 0; i < bytes; ++i) data_.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
  return *this;
}

DatasetWriter& DatasetWriter::text(const std::string& text) {
  if (text.empty()) return u8(0);
  const std::size_t length = std::min<std::size_t>(text.size(), 254);
  u8(length + 1);  // with the zero at its end
  for (std::size_t i = 0; i < length; ++i) u16(static_cast<unsigned char>(text[i]));
  return u16(0);
}

DatasetWriter& DatasetWriter::numbers16(const std::vector<std::uint16_t>& values) {
  u32(values.size());
  for (const std::uint16_t value : values) u16(value);
  return *this;
}

DatasetWriter& DatasetWriter::numbers32(const std::vector<std::uint32_t>& values) {
  u32(values.size());
  for (const std::uint32_t value : values) u32(value);
  return *this;
}

DatasetWriter& DatasetWriter::bytes(std::span<const std::uint8_t> bytes) {
  data_.insert(data_.end(), bytes.begin(), bytes.end());
  return *this;
}

std::uint64_t DatasetReader::number(int bytes) {
  if (left() < static_cast<std::size_t>(bytes)) {
    throw Protocol("simulated PTP camera: a data set of " + std::to_string(data_.size()) + " bytes ends too early");
  }
  std::uint64_t value = 0;
  for (int i = 0; i < bytes; ++i) value |= std::uint64_t{data_[place_++]} << (8 * i);
  return value;
}

std::string DatasetReader::text() {
  std::string text;
  for (auto count = number(1); count > 0; --count) {
    const std::uint16_t character = u16();
    if (character != 0) text += character < 128 ? static_cast<char>(character) : '?';
  }
  return text;
}

}  // namespace lumitexel::ptp
