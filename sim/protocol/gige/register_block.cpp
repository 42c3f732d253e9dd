#include "sim/protocol/gige/register_block.h"

#include <algorithm>
#include <bit>

namespace lumitexel::gige {
namespace {

void append_bytes(std::vector<std::uint8_t>& bytes, std::uint64_t value, int count) {
  for (int i = count - 1; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

}  // namespace

void append_be16(std::vector<std::uint8_t>& bytes, std::uint16_t value) { append_bytes(bytes, value, 2); }
void append_be32(std::vector<std::uint8_t>& bytes, std::uint32_t value) { append_bytes(bytes, value, 4); }
void append_be64(std::vector<std::uint8_t>& bytes, std::uint64_t value) { append_bytes(bytes, value, 8); }

std::uint16_t be16(std::span<const std::uint8_t> bytes) {
  return static_cast<std::uint16_t>(bytes[0] << 8 | bytes[1]);
}

std::uint32_t be32(std::span<const std::uint8_t> bytes) {
  return std::uint32_t{be16(bytes)} << 16 | be16(bytes.subspan(2));
}

std::span<const std::uint8_t> RegisterBlock::read(std::uint32_t address, std::size_t size) const {
  return std::span(bytes_).subspan(address, size);
}

void RegisterBlock::write(std::uint32_t address, std::span<const std::uint8_t> bytes) {
  std::copy(bytes.begin(), bytes.end(), bytes_.begin() + address);
}

std::uint64_t RegisterBlock::get64(std::uint32_t address) const {
  return std::uint64_t{get32(address)} << 32 | get32(address + 4);
}

double RegisterBlock::get_double(std::uint32_t address) const { return std::bit_cast<double>(get64(address)); }

void RegisterBlock::set32(std::uint32_t address, std::uint32_t value) {
  std::vector<std::uint8_t> bytes;
  append_be32(bytes, value);
  write(address, bytes);
}

void RegisterBlock::set64(std::uint32_t address, std::uint64_t value) {
  std::vector<std::uint8_t> bytes;
  append_be64(bytes, value);
  write(address, bytes);
}

void RegisterBlock::set_double(std::uint32_t address, double value) {
  set64(address, std::bit_cast<std::uint64_t>(value));
}

void RegisterBlock::set_text(std::uint32_t address, std::size_t size, const std::string& text) {
  std::fill_n(bytes_.begin() + address, size, std::uint8_t{0});
  std::copy_n(text.begin(), std::min(text.size(), size - 1), bytes_.begin() + address);
}

}  // namespace lumitexel::gige
