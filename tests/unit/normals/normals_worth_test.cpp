#include "processing/normals/normals_worth.h"

#include <gtest/gtest.h>

#include "tests/unit/normals/normal_patch.h"

namespace lumitexel {
namespace {

NormalsWorth worth(const NormalPatch& patch) {
  return normals_worth(patch.session, patch.lumitexels, patch.width, patch.bases, patch.label, patch.median_reflectance, {});
}

int said_yes(double slope_rms_rad, int seeds) {
  int yes = 0;
  for (int seed = 1; seed <= seeds; ++seed) yes += worth(make_patch({64, 10, slope_rms_rad, 0.05, static_cast<unsigned>(seed)})).enough();
  return yes;
}

// 64 texels square: eight parts to compare, four in each of two photographs.
TEST(NormalsWorth, AnExactMeshKeepsItsNormals) { EXPECT_LE(said_yes(0.0, 100), 5); }

TEST(NormalsWorth, ABumpySurfaceGetsItsOwn) { EXPECT_GE(said_yes(0.05, 20), 19); }

TEST(NormalsWorth, OnePhotographDecidesNothing) {
  const NormalsWorth found = worth(make_patch({20, 1, 0.05, 0.05, 1}));
  EXPECT_FALSE(found.enough());
}

TEST(NormalsWorth, HeldOutPhotographsAreNotLookedAt) {
  NormalPatch patch = make_patch({40, 10, 0.05, 0.05, 1});
  for (View& view : patch.session.views) view.heldout = true;
  EXPECT_EQ(worth(patch).samples, 0u);
}

}  // namespace
}  // namespace lumitexel
