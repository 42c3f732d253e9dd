#include "processing/brdf/reject_samples.h"

#include <gtest/gtest.h>

#include <limits>

#include "processing/brdf/numerics/synthetic_observations.h"

namespace lumitexel {
namespace {

constexpr float kNoNumber = std::numeric_limits<float>::quiet_NaN();

TEST(RejectSamples, CountsEachReasonAndKeepsTheRestInPlace) {
  Observations observations = random_observations(shiny_brdf(0.1, 1.0, 30.0), 4, 3, 0.0, 1);
  const Observations before = observations;
  observations.samples[0].reflectance[0] = kNoNumber;
  observations.samples[4].variance[2] = -1.0f;
  observations.samples[6].geometry.cos_o = -0.1;
  observations.samples[7].geometry.cos_i = 0.0;
  observations.samples[8].geometry.across2 = std::numeric_limits<double>::infinity();
  const RejectedSamples rejected = reject_unusable(observations);
  EXPECT_EQ(rejected.not_finite, 3u);
  EXPECT_EQ(rejected.below_surface, 2u);
  EXPECT_EQ(observations.first, (std::vector<std::size_t>{0, 2, 4, 4, 7}));
  EXPECT_EQ(observations.of(0)[0].reflectance, before.samples[1].reflectance);
  EXPECT_EQ(observations.of(1)[1].reflectance, before.samples[5].reflectance);
  EXPECT_EQ(observations.of(3)[2].reflectance, before.samples[11].reflectance);
}

TEST(RejectSamples, ChannelsThatDoNotExistDoNotCount) {
  Observations observations = random_observations(shiny_brdf(0.1, 1.0, 30.0), 1, 2, 0.0, 2);
  observations.channels = 1;
  observations.samples[0].reflectance[1] = kNoNumber;
  EXPECT_EQ(reject_unusable(observations).not_finite, 0u);
  EXPECT_EQ(observations.samples.size(), 2u);
}

}  // namespace
}  // namespace lumitexel
