#include "processing/surface/mesh_file.h"

#include <gtest/gtest.h>

#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/shared_data.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

const std::string kTetrahedron =
    "# a corner of a cube\n"
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

std::string ascii_ply(const std::string& vertices, int vertex_count, const std::string& faces, int face_count) {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertex_count) +
         "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(face_count) +
         "\nproperty list uchar int vertex_indices\nend_header\n" + vertices + faces;
}

Mesh parse_obj_text(const std::string& text) { return parse_mesh(text, ".obj", "t.obj"); }

TEST(MeshFile, ObjWithoutNormalsGetsThemFromItsTriangles) {
  const Mesh mesh = parse_obj_text(kTetrahedron);
  ASSERT_EQ(mesh.positions.size(), 4u);
  ASSERT_EQ(mesh.triangles.size(), 4u);
  // At the origin three right triangles of equal area meet, facing -x, -y and -z.
  EXPECT_LT((mesh.normals[0] + Eigen::Vector3d::Ones().normalized()).norm(), 1e-15);
  EXPECT_TRUE(mesh.texcoords.empty());
}

TEST(MeshFile, ObjCornersAreSplitByTripleAndSeamsStaySmooth) {
  // Two triangles over an edge whose texture coordinates differ on either side.
  const Mesh mesh = parse_obj_text(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nvt 0 0\nvt 1 0\nvt 0 1\nvt 0.5 0.5\n"
      "f 1/1 2/2 3/3\nf -3/4 -1/2 -2/3\n");
  ASSERT_EQ(mesh.positions.size(), 5u);  // v2 stands there with vt2 and with vt4
  const auto& second = mesh.triangles[1];
  EXPECT_EQ(mesh.positions[second[0]], mesh.positions[1]);
  EXPECT_EQ(mesh.texcoords[second[0]], Eigen::Vector2d(0.5, 0.5));
  EXPECT_EQ(mesh.normals[second[0]], mesh.normals[1]);
  EXPECT_NEAR(mesh.normals[1].norm(), 1.0, 1e-15);
}

TEST(MeshFile, PolygonsBecomeFansAndGivenNormalsBecomeUnit) {
  const Mesh mesh = parse_obj_text("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvn 0 0 5\nf 1//1 2//1 3//1 4//1\n");
  EXPECT_EQ(mesh.triangles, (std::vector<std::array<std::uint32_t, 3>>{{0, 1, 2}, {0, 2, 3}}));
  for (const Eigen::Vector3d& normal : mesh.normals) EXPECT_EQ(normal, Eigen::Vector3d::UnitZ());
}

TEST(MeshFile, BinaryPlyComesBackBitForBit) {
  const TemporaryFolder folder;
  Mesh mesh = parse_obj_text(kTetrahedron);
  mesh.positions[1].x() = 0.1234567890123456;
  for (std::size_t v = 0; v < 4; ++v) mesh.texcoords.emplace_back(0.1 * static_cast<double>(v), 1.0 / 3.0);
  write_ply(folder / "mesh.ply", mesh);
  const Mesh read = read_mesh(folder / "mesh.ply");
  EXPECT_EQ(read.positions, mesh.positions);
  EXPECT_EQ(read.texcoords, mesh.texcoords);
  EXPECT_EQ(read.triangles, mesh.triangles);
  // Unit normals are normalised again when read: the last bit may change.
  for (std::size_t v = 0; v < 4; ++v) EXPECT_LT((read.normals[v] - mesh.normals[v]).norm(), 4e-16);
}

TEST(MeshFile, AsciiPlyWithOtherPropertiesAndElementsIsRead) {
  const std::string text =
      "ply\r\nformat ascii 1.0\r\ncomment by hand\r\nelement vertex 3\r\nproperty double x\r\nproperty uchar red\r\n"
      "property float y\r\nproperty float z\r\nelement edge 1\r\nproperty int vertex1\r\nproperty int vertex2\r\n"
      "element face 1\r\nproperty uchar kind\r\nproperty list uint8 uint32 vertex_index\r\nend_header\r\n"
      "0 255 0 0\r\n1 255 0 0\r\n0 255 +2.5e-1 0\r\n0 1\r\n7 3 0 1 2\r\n";
  const Mesh mesh = parse_mesh(text, ".ply", "t.ply");
  EXPECT_EQ(mesh.positions[2], Eigen::Vector3d(0, 0.25, 0));
  EXPECT_EQ(mesh.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

TEST(MeshFile, BadObjIsNamedByLine) {
  const std::string& good = kTetrahedron;
  EXPECT_BAD_INPUT(parse_obj_text(good + "v 1 nan 0\n"), "t.obj:10", "nan");
  EXPECT_BAD_INPUT(parse_obj_text(good + "v 1 2\n"), "t.obj:10", "3 finite numbers");
  EXPECT_BAD_INPUT(parse_obj_text(good + "v 1 2x 3\n"), "t.obj:10", "2x");
  EXPECT_BAD_INPUT(parse_obj_text(good + "f 1 2 5\n"), "t.obj:10", "'5'", "1 to 4");
  EXPECT_BAD_INPUT(parse_obj_text(good + "f 1 2 0\n"), "t.obj:10", "'0'");
  EXPECT_BAD_INPUT(parse_obj_text(good + "f 1 2 -5\n"), "t.obj:10", "'-5'");
  EXPECT_BAD_INPUT(parse_obj_text(good + "f 1 2\n"), "t.obj:10", "2 corners");
  EXPECT_BAD_INPUT(parse_obj_text(good + "f 1 2 2\n"), "t.obj:10", "zero area");
  EXPECT_BAD_INPUT(parse_obj_text(good + "v 1 1 1\nf 1 2 5\n"), "t.obj:11", "manifold");
  EXPECT_BAD_INPUT(parse_obj_text("v 0.1 0.1 0.1\nv 0.2 0.2 0.2\nv 0.7 0.7 0.7\nf 1 2 3\n"), "t.obj:4", "zero area");
  EXPECT_BAD_INPUT(parse_obj_text("v 0 0 0\n"), "t.obj", "without faces");
  EXPECT_BAD_INPUT(parse_mesh(good, ".stl", "t.stl"), "t.stl", ".ply or .obj");
}

// The seam's vertices are split, but the edge is one.
TEST(MeshFile, ANonManifoldEdgeIsSeenAcrossATextureSeam) {
  EXPECT_BAD_INPUT(parse_obj_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nvt 0 0\nvt 1 1\nvt 0 1\n"
                                  "f 1/1 2/1 3/1\nf 2/2 1/2 4/2\nf 1/3 2/3 5/3\n"),
                   "t.obj:11", "manifold");
}

TEST(MeshFile, BadAsciiPlyIsNamedByLine) {
  const auto parse = [](const std::string& text) { return parse_mesh(text, ".ply", "t.ply"); };
  const std::string corners = "0 0 0\n1 0 0\n0 1 0\n";  // lines 10 to 12
  EXPECT_EQ(parse(ascii_ply(corners, 3, "3 0 1 2\n", 1)).triangles.size(), 1u);
  EXPECT_BAD_INPUT(parse(ascii_ply("0 0 0\n1 nan 0\n0 1 0\n", 3, "3 0 1 2\n", 1)), "t.ply:11", "NaN");
  EXPECT_BAD_INPUT(parse(ascii_ply("0 0 0\n1 inf 0\n0 1 0\n", 3, "3 0 1 2\n", 1)), "t.ply:11", "infinite");
  EXPECT_BAD_INPUT(parse(ascii_ply(corners, 3, "3 0 1 3\n", 1)), "t.ply:13", "index 3");
  EXPECT_BAD_INPUT(parse(ascii_ply(corners, 3, "3 0 1 -1\n", 1)), "t.ply:13", "-1");
  EXPECT_BAD_INPUT(parse(ascii_ply(corners, 3, "3 0 1 1\n", 1)), "t.ply:13", "zero area");
  EXPECT_BAD_INPUT(parse(ascii_ply(corners, 3, "3 0 1\n", 1)), "t.ply", "ends early");
  EXPECT_BAD_INPUT(parse(ascii_ply(corners, 3, "", 0)), "t.ply", "without faces");
  EXPECT_BAD_INPUT(parse(ascii_ply(corners, 3, "3 0 1 2\n", 2000)), "t.ply", "face", "ends early");
  EXPECT_BAD_INPUT(parse("ply\nformat binary_big_endian 1.0\nend_header\n"), "t.ply:2", "big_endian");
  EXPECT_BAD_INPUT(parse("ply\nformat ascii 1.0\nelement vertex\n"), "t.ply:3", "element");
  EXPECT_BAD_INPUT(parse("ply\nformat ascii 1.0\n"), "t.ply", "end_header");
  EXPECT_BAD_INPUT(parse("solid cube\n"), "t.ply", "no PLY");
}

TEST(MeshFile, ATruncatedBinaryPlyIsNamedByFace) {
  const std::string bytes = encode_ply(parse_obj_text(kTetrahedron));
  EXPECT_BAD_INPUT(parse_mesh(bytes.substr(0, bytes.size() - 2), ".ply", "t.ply"), "t.ply: face 3", "ends early");
}

TEST(MeshFile, SharedMeshesAreReadWhole) {
  SKIP_WITHOUT_SHARED_DATA("oracle_a");
  const Mesh coarse = read_mesh(shared_data() / "oracle_a/mesh.ply");
  EXPECT_EQ(coarse.positions.size(), 12002u);
  EXPECT_EQ(coarse.triangles.size(), 24000u);
  const Mesh truth = read_mesh(shared_data() / "oracle_a/truth/mesh.ply");
  EXPECT_EQ(truth.triangles.size(), 1101760u);
  EXPECT_EQ(truth.normals.size(), truth.positions.size());
  EXPECT_GT(read_mesh(shared_data() / "meshes/spot.obj").texcoords.size(), 0u);
  EXPECT_GT(read_mesh(shared_data() / "meshes/stanford-bunny.obj").triangles.size(), 0u);
}

}  // namespace
}  // namespace lumitexel
