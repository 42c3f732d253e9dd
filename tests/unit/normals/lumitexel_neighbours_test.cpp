#include "processing/normals/lumitexel_neighbours.h"

#include <gtest/gtest.h>

#include "tests/unit/normals/normal_patch.h"

namespace lumitexel {
namespace {

Neighbours neighbours_of(const NormalPatch& patch) {
  return lumitexel_neighbours(DirectedLumitexels(patch.session, patch.lumitexels), patch.width);
}

TEST(LumitexelNeighbours, AreTheFourBesideAndTheLoopsBetweenThem) {
  const Neighbours found = neighbours_of(make_patch({10, 5, 0.0, 0.0, 1}));
  EXPECT_EQ(found.count(0), 2u);
  EXPECT_EQ(found.count(5), 3u);
  EXPECT_EQ(found.count(55), 4u);
  EXPECT_EQ(found.loop.size(), 81u);
}

TEST(LumitexelNeighbours, ADepthEdgeParts) {
  NormalPatch patch = make_patch({10, 5, 0.0, 0.0, 1});
  LumitexelTile& tile = patch.lumitexels.tiles.front();
  for (std::size_t i = 0; i < 100; ++i) tile.position[i].z() = i % 10 < 5 ? 0.0 : 0.01;  // ten spacings
  const Neighbours found = neighbours_of(patch);
  for (std::size_t k = found.first[4]; k < found.first[5]; ++k) EXPECT_NE(found.other[k], 5u);
  EXPECT_EQ(found.loop.size(), 72u);  // the nine across the edge are gone
}

// Two patches apart in the atlas whose surfaces meet.
TEST(LumitexelNeighbours, ASeamOfTheAtlasDoesNotPart) {
  NormalPatch patch = make_patch({10, 5, 0.0, 0.0, 1});
  patch.width = 20;
  LumitexelTile& tile = patch.lumitexels.tiles.front();
  for (std::uint32_t i = 0; i < 100; ++i) tile.texel[i] = i / 10 * 20 + i % 10 + (i % 10 < 5 ? 0 : 7);
  const Neighbours found = neighbours_of(patch);
  bool across = false;
  for (std::size_t k = found.first[54]; k < found.first[55]; ++k) across = across || found.other[k] == 55;
  EXPECT_TRUE(across);
}

TEST(LumitexelNeighbours, TheBackOfAThinWallIsNone) {
  NormalPatch patch = make_patch({10, 5, 0.0, 0.0, 1});
  patch.width = 20;
  LumitexelTile& tile = patch.lumitexels.tiles.front();
  for (std::uint32_t i = 0; i < 100; ++i) {
    tile.texel[i] = i / 10 * 20 + i % 10 + (i % 10 < 5 ? 0 : 7);
    if (i % 10 >= 5) tile.normal[i] = -tile.normal[i];
  }
  const Neighbours found = neighbours_of(patch);
  for (std::size_t k = found.first[54]; k < found.first[55]; ++k) EXPECT_NE(found.other[k], 55u);
}

}  // namespace
}  // namespace lumitexel
