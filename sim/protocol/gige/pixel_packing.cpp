#include "sim/protocol/gige/pixel_packing.h"

#include <bit>
#include <cstring>

namespace lumitexel::gige {
namespace {

struct Codes {
  const char* stem;
  std::uint32_t one_byte, twelve, twelve_packed, twelve_p, sixteen;
};

// The codes of the standard's pixel format naming convention.
Codes codes_of(Mosaic mosaic) {
  switch (mosaic) {
    case Mosaic::Mono: return {"Mono", 0x01080001, 0x01100005, 0x010c0006, 0x010c0047, 0x01100007};
    case Mosaic::Grbg: return {"BayerGR", 0x01080008, 0x01100010, 0x010c002a, 0x010c0057, 0x0110002e};
    case Mosaic::Rggb: return {"BayerRG", 0x01080009, 0x01100011, 0x010c002b, 0x010c0059, 0x0110002f};
    case Mosaic::Gbrg: return {"BayerGB", 0x0108000a, 0x01100012, 0x010c002c, 0x010c0055, 0x01100030};
    case Mosaic::Bggr: return {"BayerBG", 0x0108000b, 0x01100013, 0x010c002d, 0x010c0053, 0x01100031};
  }
  return {};
}

void append_pair(std::vector<std::uint8_t>& bytes, Packing packing, unsigned a, unsigned b) {
  if (packing == Packing::ThreeForTwo) {
    bytes.push_back(static_cast<std::uint8_t>(a >> 4));
    bytes.push_back(static_cast<std::uint8_t>((b & 0xf) << 4 | (a & 0xf)));
    bytes.push_back(static_cast<std::uint8_t>(b >> 4));
  } else {
    bytes.push_back(static_cast<std::uint8_t>(a));
    bytes.push_back(static_cast<std::uint8_t>((b & 0xf) << 4 | a >> 8));
    bytes.push_back(static_cast<std::uint8_t>(b >> 4));
  }
}

}  // namespace

std::vector<PixelFormat> pixel_formats(Mosaic mosaic, int bits) {
  const Codes codes = codes_of(mosaic);
  const std::string stem = codes.stem;
  std::vector<PixelFormat> formats;
  if (bits <= 8) formats.push_back({stem + "8", codes.one_byte, 8, Packing::OneByte});
  if (bits <= 12) {
    formats.push_back({stem + "12", codes.twelve, 12, Packing::TwoBytes});
    formats.push_back({stem + "12Packed", codes.twelve_packed, 12, Packing::ThreeForTwo});
    formats.push_back({stem + "12p", codes.twelve_p, 12, Packing::ThreeForTwoLsb});
  }
  formats.push_back({stem + "16", codes.sixteen, 16, Packing::TwoBytes});
  return formats;
}

std::size_t packed_bytes(const PixelFormat& format, std::size_t pixels) {
  switch (format.packing) {
    case Packing::OneByte: return pixels;
    case Packing::TwoBytes: return 2 * pixels;
    default: return (pixels + 1) / 2 * 3;
  }
}

std::vector<std::uint8_t> packed(const PixelFormat& format, std::span<const std::uint16_t> samples) {
  if (format.packing == Packing::OneByte) return {samples.begin(), samples.end()};
  std::vector<std::uint8_t> bytes;
  if (format.packing == Packing::TwoBytes) {
    bytes.resize(2 * samples.size());
    if (std::endian::native == std::endian::little) {
      std::memcpy(bytes.data(), samples.data(), bytes.size());
      return bytes;
    }
    for (std::size_t i = 0; i < samples.size(); ++i) {
      bytes[2 * i] = static_cast<std::uint8_t>(samples[i]);
      bytes[2 * i + 1] = static_cast<std::uint8_t>(samples[i] >> 8);
    }
    return bytes;
  }
  bytes.reserve(packed_bytes(format, samples.size()));
  for (std::size_t i = 0; i < samples.size(); i += 2) {
    append_pair(bytes, format.packing, samples[i], i + 1 < samples.size() ? samples[i + 1] : 0u);
  }
  return bytes;
}

}  // namespace lumitexel::gige
