// One directory of a little-endian TIFF file: entries by tag, values of up to four bytes in the entry, longer ones
// behind.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace lumitexel::ptp {

struct Rational {
  std::int64_t numerator = 0, denominator = 1;  // 32 bits each in the file
};

// value as a fraction, exact to half a billionth of it or better between 1e-3 and 4e9, and exact for decimals of up to
// four places. Throws OutOfRange if it is negative, not finite or too large.
Rational unsigned_rational(double value);

class TiffDirectory {
 public:
  void bytes(std::uint16_t tag, const std::vector<std::uint8_t>& values);
  void text(std::uint16_t tag, const std::string& text);  // ASCII with its zero
  void shorts(std::uint16_t tag, const std::vector<std::uint16_t>& values);
  void long_number(std::uint16_t tag, std::uint32_t value);
  void rationals(std::uint16_t tag, const std::vector<Rational>& values, bool with_sign);
  void raw_text(std::uint16_t tag, const std::string& text);  // EXIF's "undefined": no zero

  // How many bytes encoded() will have.
  std::size_t size() const;
  // offset: of the directory in the file, even.
  std::vector<std::uint8_t> encoded(std::uint32_t offset) const;

 private:
  struct Entry {
    std::uint16_t type = 0;
    std::uint32_t count = 0;
    std::vector<std::uint8_t> value;
  };
  std::map<std::uint16_t, Entry> entries_;
};

}  // namespace lumitexel::ptp
