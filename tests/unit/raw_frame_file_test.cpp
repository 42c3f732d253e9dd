#include "rig/raw_frame_file.h"

#include <gtest/gtest.h>

#include "drivers/error.h"

namespace lumitexel {
namespace {

Frame frame_of(int bits, Mosaic mosaic) {
  Frame frame;
  frame.width_px = 3;
  frame.height_px = 2;
  frame.bits = bits;
  frame.mosaic = mosaic;
  const auto top = static_cast<std::uint16_t>((1 << bits) - 1);
  frame.samples = {0, 1, top, 10, 35, static_cast<std::uint16_t>(top / 2)};  // 10 and 35: a line end and a '#'
  return frame;
}

TEST(RawFrameFile, EveryBitDepthComesBack) {
  for (const int bits : {8, 9, 12, 14, 16}) {
    for (const Mosaic mosaic : {Mosaic::Mono, Mosaic::Rggb, Mosaic::Gbrg}) {
      const Frame frame = frame_of(bits, mosaic);
      const std::string bytes = encode_pgm(frame);
      const Frame read = decode_pgm(bytes, "f.pgm");
      EXPECT_EQ(read.samples, frame.samples);
      EXPECT_EQ(read.width_px, 3);
      EXPECT_EQ(read.height_px, 2);
      EXPECT_EQ(read.bits, bits);
      EXPECT_EQ(read.mosaic, mosaic);
      CameraLimits limits;
      limits.width_px = 3;
      limits.height_px = 2;
      limits.bits = bits;
      limits.mosaic = mosaic;
      EXPECT_EQ(pgm_bytes(limits), static_cast<std::int64_t>(bytes.size()));
    }
  }
}

TEST(RawFrameFile, SamplesAreBigEndianAsTheFormatSays) {
  const std::string bytes = encode_pgm(frame_of(12, Mosaic::Mono));
  EXPECT_EQ(bytes.substr(bytes.size() - 12, 6), std::string("\x00\x00\x00\x01\x0f\xff", 6));
}

TEST(RawFrameFile, PlainPgmOfOtherProgramsIsRead) {
  const Frame frame = decode_pgm("P5 2\t1 # made elsewhere\n255\n\x07\x08", "f.pgm");
  EXPECT_EQ(frame.samples, (std::vector<std::uint16_t>{7, 8}));
  EXPECT_EQ(frame.mosaic, Mosaic::Mono);
}

TEST(RawFrameFile, EveryTruncationIsCorrupt) {
  const std::string bytes = encode_pgm(frame_of(12, Mosaic::Bggr));
  for (std::size_t length = 0; length < bytes.size(); ++length) {
    EXPECT_THROW(decode_pgm(bytes.substr(0, length), "f.pgm"), Corrupt) << length;
  }
  EXPECT_THROW(decode_pgm(bytes + "x", "f.pgm"), Corrupt);
}

TEST(RawFrameFile, NonsenseIsCorrupt) {
  using namespace std::string_literals;
  for (const std::string& bytes : {"P6\n1 1\n255\n\x01"s, "P5\n0 1\n255\n"s, "P5\n-1 1\n255\n\x01"s, "P5\n1 1\n300\n\x01\x01"s,
                                   "P5\n1 1\n4095\n\x1f\xff"s, "P5\n2147483647 2147483647\n255\n\x01"s,
                                   "P5\n# lumitexel mosaic rgb\n1 1\n255\n\x01"s, "P5\n1 1\n99999999999\n\x01"s}) {
    EXPECT_THROW(decode_pgm(bytes, "f.pgm"), Corrupt) << bytes;
  }
}

TEST(RawFrameFile, AFrameThatIsNotWholeIsNotWritten) {
  Frame frame = frame_of(12, Mosaic::Mono);
  frame.samples.pop_back();
  EXPECT_THROW(encode_pgm(frame), Protocol);
  frame.samples.push_back(4096);
  EXPECT_THROW(encode_pgm(frame), Protocol);
}

}  // namespace
}  // namespace lumitexel
