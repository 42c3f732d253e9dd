// Big-endian memory, as registers lie in a GigE Vision device.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace lumitexel::gige {

// Appends a value's bytes, highest first.
void append_be16(std::vector<std::uint8_t>& bytes, std::uint16_t value);
void append_be32(std::vector<std::uint8_t>& bytes, std::uint32_t value);
void append_be64(std::vector<std::uint8_t>& bytes, std::uint64_t value);
std::uint16_t be16(std::span<const std::uint8_t> bytes);  // of its first two
std::uint32_t be32(std::span<const std::uint8_t> bytes);  // of its first four

// Addresses are not checked: whoever serves a client checks them first.
class RegisterBlock {
 public:
  explicit RegisterBlock(std::size_t bytes) : bytes_(bytes, 0) {}

  std::size_t size() const { return bytes_.size(); }
  std::span<const std::uint8_t> read(std::uint32_t address, std::size_t size) const;
  void write(std::uint32_t address, std::span<const std::uint8_t> bytes);

  std::uint32_t get32(std::uint32_t address) const { return be32(read(address, 4)); }
  std::uint64_t get64(std::uint32_t address) const;
  double get_double(std::uint32_t address) const;
  void set32(std::uint32_t address, std::uint32_t value);
  void set64(std::uint32_t address, std::uint64_t value);
  void set_double(std::uint32_t address, double value);
  // Cut or padded with zeros to `size` bytes, the last one zero.
  void set_text(std::uint32_t address, std::size_t size, const std::string& text);

 private:
  std::vector<std::uint8_t> bytes_;
};

}  // namespace lumitexel::gige
