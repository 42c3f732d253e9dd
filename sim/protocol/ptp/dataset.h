// PTP's data sets: little-endian numbers, counted arrays, counted UTF-16 texts.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lumitexel::ptp {

class DatasetWriter {
 public:
  DatasetWriter& u8(std::uint64_t value) { return number(value, 1); }
  DatasetWriter& u16(std::uint64_t value) { return number(value, 2); }
  DatasetWriter& u32(std::uint64_t value) { return number(value, 4); }
  DatasetWriter& u64(std::uint64_t value) { return number(value, 8); }
  DatasetWriter& number(std::uint64_t value, int bytes);
  // ASCII, at most 254 characters; longer texts are cut.
  DatasetWriter& text(const std::string& text);
  DatasetWriter& numbers16(const std::vector<std::uint16_t>& values);
  DatasetWriter& numbers32(const std::vector<std::uint32_t>& values);
  DatasetWriter& bytes(std::span<const std::uint8_t> bytes);

  const std::vector<std::uint8_t>& data() const { return data_; }
  std::vector<std::uint8_t> take() { return std::move(data_); }

 private:
  std::vector<std::uint8_t> data_;
};

// Reading past the end throws Protocol.
class DatasetReader {
 public:
  explicit DatasetReader(std::span<const std::uint8_t> data) : data_(data) {}
  std::uint64_t number(int bytes);
  std::uint16_t u16() { return static_cast<std::uint16_t>(number(2)); }
  std::uint32_t u32() { return static_cast<std::uint32_t>(number(4)); }
  std::string text();  // characters beyond ASCII become '?'
  std::size_t left() const { return data_.size() - place_; }

 private:
  std::span<const std::uint8_t> data_;
  std::size_t place_ = 0;
};

}  // namespace lumitexel::ptp
