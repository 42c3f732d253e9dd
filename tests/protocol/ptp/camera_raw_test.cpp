#include "drivers/gphoto/camera_raw.h"

#include <gtest/gtest.h>

#include <cmath>

#include "drivers/error.h"
#include "sim/protocol/ptp/dng_writer.h"
#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

std::vector<std::uint16_t> noise(int width_px, int height_px, int bits) {
  std::vector<std::uint16_t> samples(static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    samples[i] = static_cast<std::uint16_t>(scrambled(i) & ((1u << bits) - 1u));
  }
  return samples;
}

ptp::DngContent content_of(const std::vector<std::uint16_t>& samples, int width_px, int height_px, int bits,
                           Mosaic mosaic) {
  ptp::DngContent content;
  content.width_px = width_px;
  content.height_px = height_px;
  content.bits = bits;
  content.mosaic = mosaic;
  content.samples = samples;
  content.black_level_dn = 256.5;
  content.exposure_s = 1.0 / 3.0;
  content.iso = 400;
  content.make = "Lumitexel";
  content.model = "Test";
  content.serial = "0042";
  content.artist = "lumitexel-18446744073709551615";
  content.utc_ns = 1'767'225'599'987'654'321;  // 2025-12-31 23:59:59
  content.image_number = 70'000;
  content.temperature_c = -3.25;
  return content;
}

struct Kind {
  int width_px, height_px, bits;
  Mosaic mosaic;
};

class CameraRawOf : public testing::TestWithParam<Kind> {};

TEST_P(CameraRawOf, AWrittenFileHoldsTheSameIntegers) {
  const auto [width_px, height_px, bits, mosaic] = GetParam();
  const auto samples = noise(width_px, height_px, bits);
  const CameraRaw raw = decode_camera_raw(write_dng(content_of(samples, width_px, height_px, bits, mosaic)), "test");
  EXPECT_EQ(raw.width_px, width_px);
  EXPECT_EQ(raw.height_px, height_px);
  EXPECT_EQ(raw.bits, bits);
  EXPECT_EQ(raw.mosaic, mosaic);
  EXPECT_EQ(raw.samples, samples);
}

// Odd sizes; 32 x 24 is the smallest that is of any use here.
INSTANTIATE_TEST_SUITE_P(Kinds, CameraRawOf,
                         testing::Values(Kind{64, 48, 14, Mosaic::Rggb}, Kind{64, 48, 16, Mosaic::Bggr},
                                         Kind{65, 49, 12, Mosaic::Grbg}, Kind{301, 200, 10, Mosaic::Gbrg},
                                         Kind{64, 48, 16, Mosaic::Mono}, Kind{77, 51, 12, Mosaic::Mono},
                                         Kind{32, 24, 14, Mosaic::Rggb}));

TEST(CameraRaw, ExifSaysWhatWasWritten) {
  const auto samples = noise(64, 48, 14);
  const CameraRawExif exif = decode_camera_raw(write_dng(content_of(samples, 64, 48, 14, Mosaic::Rggb)), "test").exif;
  ASSERT_TRUE(exif.exposure_s && exif.iso && exif.time_s && exif.image_number && exif.temperature_c);
  EXPECT_NEAR(*exif.exposure_s, 1.0 / 3.0, 1e-9 / 3.0);
  EXPECT_EQ(*exif.iso, 400.0);
  EXPECT_EQ(exif.artist, "lumitexel-18446744073709551615");
  EXPECT_TRUE(exif.has_subseconds);
  EXPECT_NEAR(*exif.time_s, 1'767'225'599.987654, 1e-6);
  EXPECT_EQ(*exif.image_number, 70'000u);
  EXPECT_NEAR(*exif.temperature_c, -3.25, 0.01);
}

TEST(CameraRaw, ExposuresOfADialAreExact) {
  const auto samples = noise(64, 48, 14);
  ptp::DngContent content = content_of(samples, 64, 48, 14, Mosaic::Rggb);
  for (const double exposure_s : {0.0001, 0.0010, 0.0333, 0.1, 1.3, 30.0, 3600.0, 1.0 / 8000.0, 1.23456789e-5}) {
    content.exposure_s = exposure_s;
    const CameraRawExif exif = decode_camera_raw(write_dng(content), "test").exif;
    ASSERT_TRUE(exif.exposure_s);
    EXPECT_NEAR(*exif.exposure_s, exposure_s, 5e-10 + 1e-9 * exposure_s);
  }
}

TEST(CameraRaw, AFileThatEndsTooEarlyIsCorruptAndNamed) {
  const auto samples = noise(64, 48, 14);
  const auto whole = write_dng(content_of(samples, 64, 48, 14, Mosaic::Rggb));
  for (std::size_t size = 0; size < whole.size(); size += size < 1200 ? 37 : 501) {
    try {
      decode_camera_raw(std::span(whole).first(size), "frame 7");
      ADD_FAILURE() << "took the first " << size << " of " << whole.size() << " bytes for a whole file";
    } catch (const Corrupt& error) {
      EXPECT_NE(std::string(error.what()).find("frame 7"), std::string::npos);
    }
  }
  EXPECT_THROW(decode_camera_raw(std::span(whole).first(whole.size() - 1), "frame 7"), Corrupt);
}

TEST(CameraRaw, OtherBytesAreCorrupt) {
  std::vector<std::uint8_t> bytes(10'000);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::uint8_t>(scrambled(i));
  EXPECT_THROW(decode_camera_raw(bytes, "noise"), Corrupt);
  EXPECT_THROW(decode_camera_raw(std::vector<std::uint8_t>(10'000), "zeros"), Corrupt);
  EXPECT_THROW(decode_camera_raw({}, "nothing"), Corrupt);
}

// A damaged head may still mean a picture, even another one; it must not mean anything else than that or Corrupt.
TEST(CameraRaw, DamagedHeadsAreAPictureOrCorrupt) {
  const auto samples = noise(64, 48, 14);
  const auto whole = write_dng(content_of(samples, 64, 48, 14, Mosaic::Rggb));
  const std::size_t head = whole.size() - 2 * samples.size();
  int corrupt = 0, pictures = 0;
  for (std::uint64_t round = 0; round < 1500; ++round) {
    CounterRandom random(extended_key(std::uint64_t{7}, round), 0);
    auto damaged = whole;
    const int bytes = 1 + static_cast<int>(3.0 * random.uniform());
    for (int i = 0; i < bytes; ++i) {
      const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(head));
      damaged[at] = static_cast<std::uint8_t>(256.0 * random.uniform());
    }
    try {
      const CameraRaw raw = decode_camera_raw(damaged, "damaged");
      ++pictures;
      EXPECT_EQ(raw.samples.size(), static_cast<std::size_t>(raw.width_px) * static_cast<std::size_t>(raw.height_px));
      EXPECT_LE(*std::max_element(raw.samples.begin(), raw.samples.end()), (1u << raw.bits) - 1u);
    } catch (const Corrupt&) {
      ++corrupt;
    }
  }
  EXPECT_GT(corrupt, 50);
  EXPECT_GT(pictures, 50);
}

TEST(DngWriter, RefusesSamplesThatAreNotThePictures) {
  const auto samples = noise(64, 48, 14);
  EXPECT_THROW(write_dng(content_of(samples, 64, 47, 14, Mosaic::Rggb)), OutOfRange);
  ptp::DngContent content = content_of(samples, 64, 48, 14, Mosaic::Rggb);
  content.exposure_s = std::nan("");
  EXPECT_THROW(write_dng(content), OutOfRange);
}

}  // namespace
}  // namespace lumitexel
