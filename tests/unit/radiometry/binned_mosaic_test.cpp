#include "processing/image/binned_mosaic.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace lumitexel {
namespace {

MosaicRadiance checked(int width, int height, Mosaic mosaic) {
  MosaicRadiance image;
  image.width = width;
  image.height = height;
  image.mosaic = mosaic;
  const auto pixels = static_cast<std::size_t>(width * height);
  image.variance.assign(pixels, 16.0f);
  image.flags.assign(pixels, 0);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.value.push_back((x + y) % 2 == 0 ? 100.0f : static_cast<float>(x));  // green where x + y is odd
  }
  return image;
}

// A ramp of green comes out at the middle of every block, however bright red and blue are.
TEST(BinnedMosaic, IsTheGreenInTheMiddleOfABlock) {
  const MosaicRadiance image = binned(checked(9, 6, Mosaic::Rggb), 4);
  EXPECT_EQ(image.mosaic, Mosaic::Mono);
  ASSERT_EQ(image.value.size(), 2u);  // a column and two rows fill no block
  EXPECT_EQ(image.value[1], 5.5f);
  EXPECT_EQ(image.variance[1], 2.0f);
}

TEST(BinnedMosaic, ABlockHasItsPixelsFlags) {
  MosaicRadiance image = checked(4, 4, Mosaic::Rggb);
  image.flags[image.index(3, 2)] = kPixelSaturated;
  image.flags[image.index(0, 0)] = kPixelSaturated;  // red: does not count
  EXPECT_EQ(binned(image, 2).flags, (std::vector<std::uint8_t>{0, 0, 0, kPixelSaturated}));
}

TEST(BinnedMosaic, OneIsTheImageItselfAndOddBlocksOfColoursAreNone) {
  const MosaicRadiance image = checked(4, 4, Mosaic::Rggb);
  EXPECT_EQ(binned(image, 1).value, image.value);
  EXPECT_THROW(binned(image, 3), std::invalid_argument);
  EXPECT_EQ(binned(checked(4, 4, Mosaic::Mono), 3).value.size(), 1u);
}

}  // namespace
}  // namespace lumitexel
