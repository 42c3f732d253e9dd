#include "processing/surface/wedge_texcoords.h"

#include "processing/surface/mesh_file.h"
#include "tests/unit/bad_input_matcher.h"

namespace lumitexel {
namespace {

// Two triangles that share an edge, with their own texture coordinates at one of its ends.
std::string ply(const std::string& second_face) {
  return "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement face 2\n"
         "property list uchar int vertex_indices\nproperty list uchar float texcoord\nend_header\n"
         "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 2 6 0 0 0.5 0 0.5 0.5\n" +
         second_face + "\n";
}

TEST(WedgeTexcoords, CornersOfFacesMakeVertices) {
  const Mesh mesh = parse_mesh(ply("3 0 2 3 6 0 0 0.75 1 0 1"), ".ply", "t.ply");
  ASSERT_EQ(mesh.texcoords.size(), 5u);  // the third position has two
  ASSERT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.triangles[0][0], mesh.triangles[1][0]);
  EXPECT_NE(mesh.triangles[0][2], mesh.triangles[1][1]);
  EXPECT_EQ(mesh.texcoords[mesh.triangles[0][2]], Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(mesh.texcoords[mesh.triangles[1][1]], Eigen::Vector2d(0.75, 1));
  EXPECT_EQ(mesh.positions[mesh.triangles[1][1]], Eigen::Vector3d(1, 1, 0));
  EXPECT_EQ(mesh.normals[mesh.triangles[1][1]], Eigen::Vector3d::UnitZ());
}

TEST(WedgeTexcoords, AFaceWithoutThemLeavesTheMeshWithoutAnyAndWrongCountsAreNamed) {
  EXPECT_TRUE(parse_mesh(ply("3 0 2 3 0"), ".ply", "t.ply").texcoords.empty());
  EXPECT_BAD_INPUT(parse_mesh(ply("3 0 2 3 5 0 0 1 1 0"), ".ply", "t.ply"), "face 1", "5 numbers", "6");
  EXPECT_BAD_INPUT(parse_mesh(ply("3 0 2 9 6 0 0 1 1 0 1"), ".ply", "t.ply"), "index 9");
}

}  // namespace
}  // namespace lumitexel
