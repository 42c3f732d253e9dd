#include "processing/normals/lumitexel_bands.h"

#include <gtest/gtest.h>

#include "tests/unit/normals/normal_patch.h"

namespace lumitexel {
namespace {

TEST(LumitexelBands, AreAllWhereFewAreThere) {
  const NormalPatch patch = make_patch({40, 5, 0.05, 0.0, 1});
  const LumitexelBands bands = lumitexel_bands(patch.lumitexels, patch.width, 1600);
  EXPECT_EQ(bands.set.size(), 1600u);
  EXPECT_EQ(bands.set.samples(), patch.lumitexels.samples());
}

TEST(LumitexelBands, AreWholeRowsWithTheirOwnSamples) {
  const NormalPatch patch = make_patch({128, 5, 0.05, 0.0, 1});
  const LumitexelBands bands = lumitexel_bands(patch.lumitexels, patch.width, 8192);  // of 16384: every second band of 32 rows
  ASSERT_EQ(bands.set.size(), 8192u);
  const DirectedLumitexels all(patch.session, patch.lumitexels), some(patch.session, bands.set);
  std::vector<DirectedSample> here, there;
  for (const std::size_t i : {std::size_t{0}, std::size_t{4095}, std::size_t{4096}, std::size_t{8191}}) {
    EXPECT_EQ(some.texel(i), all.texel(bands.lumitexel[i]));
    some.samples_of(i, here);
    all.samples_of(bands.lumitexel[i], there);
    ASSERT_EQ(here.size(), there.size());
    for (std::size_t s = 0; s < here.size(); ++s) EXPECT_EQ(here[s].observation.reflectance, there[s].observation.reflectance);
  }
  EXPECT_EQ(bands.block[4095], bands.block[4094]);
  EXPECT_NE(bands.block[4096], bands.block[4095]);
  EXPECT_NE(bands.block[0], bands.block[32]);
  EXPECT_EQ(bands.block[0], bands.block[31 * 128 + 31]);
}

TEST(DirectedLumitexels, GiveOnlyTheViewsAskedFor) {
  const NormalPatch patch = make_patch({10, 5, 0.0, 0.0, 1});
  const DirectedLumitexels all(patch.session, patch.lumitexels), some(patch.session, patch.lumitexels, {false, true, false, true, false});
  std::vector<DirectedSample> here, there;
  some.samples_of(7, here);
  all.samples_of(7, there);
  ASSERT_EQ(there.size(), 5u);
  ASSERT_EQ(here.size(), 2u);
  EXPECT_EQ(here[0].wi, there[1].wi);
  EXPECT_EQ(here[1].wi, there[3].wi);
}

}  // namespace
}  // namespace lumitexel
