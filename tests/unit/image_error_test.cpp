#include "processing/evaluation/image_error.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lumitexel {
namespace {

constexpr double kRounding = 1e-6;  // images hold floats

Image row(const std::vector<float>& values) {
  Image image(static_cast<int>(values.size()), 1, 1);
  image.data = values;
  return image;
}

ErrorSums sums_of(const Image& prediction, const Image& photograph, const std::vector<std::uint8_t>& counted) {
  ErrorSums sums;
  sums.add(prediction, photograph, counted);
  return sums;
}

TEST(ImageError, AsComputedByHand) {
  // Errors 1, -4, (not counted), 0; photographs 4, 9, 16; roots 2, 3, 4 against sqrt(5), sqrt(5), 4.
  const ImageError error = sums_of(row({5, 5, 100, 16}), row({4, 9, 1, 16}), {1, 1, 0, 1}).error();
  EXPECT_NEAR(error.relative_rms, std::sqrt(17.0 / (16 + 81 + 256)), kRounding);
  EXPECT_NEAR(error.clipped_rms, std::sqrt(17.0 / (16 + 81 + 256)), kRounding)
      << "the percentile is the largest of three";
  const double root5 = std::sqrt(5.0);
  EXPECT_NEAR(error.sqrt_rms, std::sqrt(((root5 - 2) * (root5 - 2) + (root5 - 3) * (root5 - 3)) / (4 + 9 + 16)),
              kRounding);
  EXPECT_NEAR(error.psnr_db, 10.0 * std::log10(256.0 / (17.0 / 3.0)), kRounding);
}

TEST(ImageError, ClippingTakesAwayTheTopThousandth) {
  // 2000 ones, of which the last two are highlights: the 99.9th percentile is 1.
  std::vector<float> photograph(2000, 1.0f), prediction(2000, 0.9f);
  photograph[1998] = photograph[1999] = 1000.0f;
  prediction[1998] = 50.0f;  // clipped to 1 as the photograph is
  prediction[1999] = 0.5f;
  const ImageError error = sums_of(row(prediction), row(photograph), std::vector<std::uint8_t>(2000, 1)).error();
  EXPECT_NEAR(error.clipped_rms, std::sqrt((1998 * 0.01 + 0.25) / 2000), kRounding);
  EXPECT_GT(error.relative_rms, 0.9);
}

TEST(ImageError, NegativeValuesHaveNoRootAndCountAsZero) {
  EXPECT_NEAR(sums_of(row({-3, 4}), row({1, 4}), {1, 1}).error().sqrt_rms, std::sqrt(1.0 / 5.0), kRounding);
}

TEST(ImageError, ViewsArePooledEachWithItsOwnPeak) {
  ErrorSums pooled = sums_of(row({1, 2}), row({1, 4}), {1, 1});
  pooled.add(sums_of(row({10}), row({20}), {1}));
  EXPECT_EQ(pooled.values(), 3);
  EXPECT_NEAR(pooled.error().relative_rms, std::sqrt((4.0 + 100.0) / (1 + 16 + 400)), kRounding);
  EXPECT_NEAR(pooled.error().psnr_db, -10.0 * std::log10((4.0 / 16.0 + 100.0 / 400.0) / 3.0), kRounding);
}

TEST(ImageError, NothingToCompareIsNotANumber) {
  EXPECT_TRUE(std::isnan(ErrorSums().error().relative_rms));
  EXPECT_TRUE(std::isnan(ErrorSums().error().psnr_db));
  EXPECT_TRUE(std::isinf(sums_of(row({1}), row({1}), {1}).error().psnr_db));
}

TEST(ImageError, PercentileIsTheNearestRank) {
  const Image image = row({5, 1, 4, 2, 3, 99});
  const std::vector<std::uint8_t> counted{1, 1, 1, 1, 1, 0};
  EXPECT_EQ(percentile(image, counted, 0.2), 1.0);
  EXPECT_EQ(percentile(image, counted, 0.21), 2.0);
  EXPECT_EQ(percentile(image, counted, 1.0), 5.0);
  EXPECT_EQ(percentile(image, std::vector<std::uint8_t>(6, 0), 0.5), 0.0);
}

}  // namespace
}  // namespace lumitexel
