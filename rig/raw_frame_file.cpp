#include "rig/raw_frame_file.h"

#include <algorithm>
#include <cctype>
#include <charconv>

#include "drivers/error.h"

namespace lumitexel {
namespace {

constexpr std::string_view kMosaicComment = "# lumitexel mosaic ";
constexpr std::int64_t kMostPixels = std::int64_t{1} << 32;  // no sensor comes near; a damaged header may

int maxval(int bits) { return (1 << bits) - 1; }

std::string header(int width_px, int height_px, int bits, Mosaic mosaic) {
  return "P5\n" + std::string(kMosaicComment) + to_string(mosaic) + "\n" + std::to_string(width_px) + " " +
         std::to_string(height_px) + "\n" + std::to_string(maxval(bits)) + "\n";
}

// Reads the header of a PGM: tokens parted by white space and comments.
class HeaderReader {
 public:
  HeaderReader(std::string_view bytes, const std::string& where) : bytes_(bytes), where_(where) {}

  void magic() {
    if (!bytes_.starts_with("P5")) fail("does not begin with P5");
    at_ = 2;
  }
  int number(const char* what) {
    skip_space_and_comments();
    int value = 0;
    const auto [end, error] = std::from_chars(bytes_.data() + at_, bytes_.data() + bytes_.size(), value);
    if (error != std::errc{} || value <= 0) fail(std::string("has no valid ") + what);
    at_ = static_cast<std::size_t>(end - bytes_.data());
    return value;
  }
  // What follows the one white space that ends the header.
  std::string_view rest() const {
    if (at_ >= bytes_.size() || !space(bytes_[at_])) fail("ends within its header");
    return bytes_.substr(at_ + 1);
  }
  Mosaic mosaic() const { return mosaic_; }
  [[noreturn]] void fail(const std::string& what) const { throw Corrupt(where_ + ": " + what); }

 private:
  static bool space(char c) { return std::isspace(static_cast<unsigned char>(c)) != 0; }

  void skip_space_and_comments() {
    while (at_ < bytes_.size() && (space(bytes_[at_]) || bytes_[at_] == '#')) {
      if (space(bytes_[at_])) {
        ++at_;
        continue;
      }
      const std::size_t end = std::min(bytes_.find('\n', at_), bytes_.size());
      comment(bytes_.substr(at_, end - at_));
      at_ = end;
    }
  }
  void comment(std::string_view line) {
    if (!line.starts_with(kMosaicComment)) return;
    try {
      mosaic_ = mosaic_from_string(std::string(line.substr(kMosaicComment.size())));
    } catch (const BadInput& error) {
      fail(error.what());
    }
  }

  std::string_view bytes_;
  const std::string& where_;
  std::size_t at_ = 0;
  Mosaic mosaic_ = Mosaic::Mono;
};

int bits_of(int max, const HeaderReader& reader) {
  for (int bits = 1; bits <= 16; ++bits) {
    if (max == maxval(bits)) return bits;
  }
  reader.fail("has maxval " + std::to_string(max) + ", not 2^bits - 1 for 1 to 16 bits");
}

std::uint16_t sample_at(std::string_view data, std::size_t i, bool two_bytes) {
  const auto byte = [&](std::size_t k) { return static_cast<unsigned>(static_cast<unsigned char>(data[k])); };
  return static_cast<std::uint16_t>(two_bytes ? byte(2 * i) << 8 | byte(2 * i + 1) : byte(i));
}

}  // namespace

std::string encode_pgm(const Frame& frame) {
  const std::size_t pixels = static_cast<std::size_t>(frame.width_px) * static_cast<std::size_t>(frame.height_px);
  if (frame.samples.size() != pixels) {
    throw Protocol("frame of " + std::to_string(frame.width_px) + " x " + std::to_string(frame.height_px) +
                   " pixels holds " + std::to_string(frame.samples.size()) + " samples");
  }
  const int max = maxval(frame.bits);
  const bool two_bytes = max > 255;
  std::string bytes = header(frame.width_px, frame.height_px, frame.bits, frame.mosaic);
  bytes.reserve(bytes.size() + pixels * (two_bytes ? 2 : 1));
  for (const std::uint16_t sample : frame.samples) {
    if (sample > max) {
      throw Protocol("frame of " + std::to_string(frame.bits) + " bits holds a sample of " + std::to_string(sample));
    }
    if (two_bytes) bytes += static_cast<char>(sample >> 8);
    bytes += static_cast<char>(sample & 255);
  }
  return bytes;
}

std::int64_t pgm_bytes(const CameraLimits& limits) {
  const std::int64_t pixels = std::int64_t{limits.width_px} * limits.height_px;
  const std::string head = header(limits.width_px, limits.height_px, limits.bits, limits.mosaic);
  return static_cast<std::int64_t>(head.size()) + pixels * (maxval(limits.bits) > 255 ? 2 : 1);
}

Frame decode_pgm(std::string_view bytes, const std::string& where) {
  HeaderReader reader(bytes, where);
  reader.magic();
  Frame frame;
  frame.width_px = reader.number("width");
  frame.height_px = reader.number("height");
  const int max = reader.number("maxval");
  frame.bits = bits_of(max, reader);
  frame.mosaic = reader.mosaic();
  const std::string_view data = reader.rest();
  const std::int64_t pixels = std::int64_t{frame.width_px} * frame.height_px;
  const bool two_bytes = max > 255;
  if (pixels > kMostPixels || data.size() != static_cast<std::size_t>(pixels) * (two_bytes ? 2 : 1)) {
    reader.fail("holds " + std::to_string(data.size()) + " bytes for " + std::to_string(frame.width_px) + " x " +
                std::to_string(frame.height_px) + " samples");
  }
  frame.samples.resize(static_cast<std::size_t>(pixels));
  for (std::size_t i = 0; i < frame.samples.size(); ++i) {
    frame.samples[i] = sample_at(data, i, two_bytes);
    if (frame.samples[i] > max) reader.fail("sample " + std::to_string(i) + " is above its maxval");
  }
  return frame;
}

}  // namespace lumitexel
