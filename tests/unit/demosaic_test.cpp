#include "processing/image/demosaic.h"

#include <gtest/gtest.h>

namespace lumitexel {
namespace {

// Linear across the picture, with another plane per colour.
double plane(int c, double x, double y) { return 10.0 + 3.0 * c + (0.5 + c) * x - (0.25 * c - 0.3) * y; }

MosaicRadiance ramp(Mosaic mosaic, int width = 12, int height = 10) {
  MosaicRadiance m;
  m.width = width;
  m.height = height;
  m.mosaic = mosaic;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) m.value.push_back(static_cast<float>(plane(mosaic_channel(mosaic, x, y), x, y)));
  }
  m.variance.assign(m.value.size(), 4.0f);
  m.flags.assign(m.value.size(), 0);
  return m;
}

class EveryMosaic : public testing::TestWithParam<Mosaic> {};

TEST_P(EveryMosaic, IsExactOnARampInTheInterior) {
  const RadianceImage image = demosaic(ramp(GetParam()));
  for (int y = 1; y < 9; ++y) {
    for (int x = 1; x < 11; ++x) {
      for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(image.radiance.at(x, y, c), plane(c, x, y), 1e-5) << x << ' ' << y << ' ' << c;
    }
  }
}

TEST_P(EveryMosaic, IsExactOnAConstantUpToTheCorners) {
  MosaicRadiance m = ramp(GetParam());
  std::fill(m.value.begin(), m.value.end(), 7.0f);
  for (const float value : demosaic(m).radiance.data) EXPECT_FLOAT_EQ(value, 7.0f);
}

TEST_P(EveryMosaic, PropagatesVariances) {
  const RadianceImage image = demosaic(ramp(GetParam()));
  for (int y = 2; y < 8; ++y) {
    for (int x = 2; x < 10; ++x) {
      const int own = mosaic_channel(GetParam(), x, y);
      for (int c = 0; c < 3; ++c) {
        // Own sample: 4. Red and blue at green: two neighbours. All else: four.
        const float expected = c == own ? 4.0f : own == 1 ? 2.0f : 1.0f;
        EXPECT_FLOAT_EQ(image.variance.at(x, y, c), expected);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Demosaic, EveryMosaic, testing::Values(Mosaic::Rggb, Mosaic::Bggr, Mosaic::Grbg, Mosaic::Gbrg),
                         [](const auto& tested) { return to_string(tested.param); });

TEST(Demosaic, LeavesADefectiveSampleOutEverywhere) {
  MosaicRadiance m = ramp(Mosaic::Rggb);
  std::fill(m.value.begin(), m.value.end(), 7.0f);
  m.value[m.index(4, 4)] = 1e6f;
  m.flags[m.index(4, 4)] = kPixelDefective;
  const RadianceImage image = demosaic(m);
  for (const float value : image.radiance.data) EXPECT_FLOAT_EQ(value, 7.0f);
  for (const std::uint8_t flag : image.flags) EXPECT_EQ(flag, 0);
}

TEST(Demosaic, ASaturatedSampleMarksAllThatUseItAndOnlyThese) {
  MosaicRadiance m = ramp(Mosaic::Rggb);
  m.flags[m.index(4, 4)] = kPixelSaturated;  // a red one: used by all eight neighbours
  const RadianceImage image = demosaic(m);
  for (int y = 0; y < 10; ++y) {
    for (int x = 0; x < 12; ++x) {
      const bool uses = std::abs(x - 4) <= 1 && std::abs(y - 4) <= 1;
      EXPECT_EQ(image.flag(x, y), uses ? kPixelSaturated : 0) << x << ' ' << y;
    }
  }
}

TEST(Demosaic, IsDarkOnlyWhereAllSamplesAre) {
  MosaicRadiance m = ramp(Mosaic::Rggb);
  m.flags[m.index(4, 4)] = kPixelDark;
  for (const std::uint8_t flag : demosaic(m).flags) EXPECT_EQ(flag, 0);
  std::fill(m.flags.begin(), m.flags.end(), kPixelDark);
  for (const std::uint8_t flag : demosaic(m).flags) EXPECT_EQ(flag, kPixelDark);
}

TEST(Demosaic, MonoPassesThrough) {
  MosaicRadiance m = ramp(Mosaic::Mono);
  m.flags[5] = kPixelSaturated;
  const RadianceImage image = demosaic(m);
  EXPECT_EQ(image.radiance.channels, 1);
  EXPECT_EQ(image.radiance.data, m.value);
  EXPECT_EQ(image.variance.data, m.variance);
  EXPECT_EQ(image.flags, m.flags);
}

}  // namespace
}  // namespace lumitexel
