#include "processing/image/radiance_image.h"

#include <gtest/gtest.h>

#include "drivers/error.h"
#include "processing/image/exr_file.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

RadianceImage sample(int channels) {
  RadianceImage image{
      Image(2, 2, channels), Image(2, 2, channels), {0, kPixelSaturated, kPixelOutside | kPixelDark, 255}};
  for (std::size_t i = 0; i < image.radiance.data.size(); ++i) {
    image.radiance.data[i] = 0.1f * static_cast<float>(i);
    image.variance.data[i] = 1e-7f * static_cast<float>(i + 1);
  }
  return image;
}

TEST(RadianceImageFile, ComesBackBitForBit) {
  const TemporaryFolder folder;
  for (const int channels : {1, 3}) {
    const RadianceImage written = sample(channels);
    write_radiance_image(folder / "view.exr", written);
    const RadianceImage read = read_radiance_image(folder / "view.exr");
    EXPECT_EQ(read.radiance.channels, channels);
    EXPECT_EQ(read.radiance.data, written.radiance.data);
    EXPECT_EQ(read.variance.data, written.variance.data);
    EXPECT_EQ(read.flags, written.flags);
  }
}

TEST(RadianceImageFile, WhatIsMissingIsCorrupt) {
  const TemporaryFolder folder;
  EXPECT_THROW(read_radiance_image(folder / "none.exr"), Corrupt);
  write_exr_colour(folder / "plain.exr", sample(3).radiance);
  EXPECT_THROW(read_radiance_image(folder / "plain.exr"), Corrupt);
}

}  // namespace
}  // namespace lumitexel
