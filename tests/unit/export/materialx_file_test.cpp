#include "processing/export/materialx_file.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "processing/export/export_model.h"
#include "processing/surface/mesh_file.h"
#include "rig/whole_file.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

// Every reference meets a node, and every file lies there: by an XML parser that has nothing to do with the writer.
constexpr const char* kCheck = R"PY(
import json, os, sys, xml.etree.ElementTree as tree
root = tree.parse(os.path.join(sys.argv[1], "model.mtlx")).getroot()
graph = root.find("nodegraph")
nodes = {node.get("name") for node in graph}
for value in graph.iter("input"):
    assert value.get("nodename") in nodes | {None}, value.attrib
    if value.get("name") == "file":
        assert os.path.isfile(os.path.join(sys.argv[1], value.get("value"))), value.attrib
shader = root.find("gltf_pbr")
assert json.loads(shader.get("conversion_loss"))["views"] == 12
outputs = {node.get("name") for node in graph.findall("output")}
wanted = [value.get("output") for value in shader if value.get("output")]
assert wanted and set(wanted) == outputs, (wanted, outputs)
assert all(value.get("nodename") in nodes for value in graph.findall("output"))
assert root.find("surfacematerial/input").get("nodename") == shader.get("name")
)PY";

void expect_whole(const Model& model) {
  if (std::system("command -v python3 >/dev/null") != 0) GTEST_SKIP() << "PYTHON MISSING: model.mtlx is not parsed, so this is not tested";
  const TemporaryFolder folder;
  NoProgress quiet;
  export_model(model, ExportFormat::Materialx, folder / "mtlx", quiet);
  write_whole_file(folder / "check.py", kCheck);
  EXPECT_EQ(std::system(("python3 " + (folder / "check.py").string() + " " + (folder / "mtlx").string()).c_str()), 0)
      << read_whole_file(folder / "mtlx/model.mtlx");
  const Mesh mesh = read_mesh(folder / "mtlx/mesh.obj");
  EXPECT_EQ(mesh.triangles.size(), model.mesh.triangles.size());
}

TEST(MaterialxFile, IsWellFormedAndItsReferencesMeet) { expect_whole(model_of(sphere_mesh(24, 12), 16, 8, diffuse_brdf(0.2, 0.1, 0.05))); }

TEST(MaterialxFile, AlsoWithNormals) {
  expect_whole(with_own_normals(model_of(sphere_mesh(24, 12), 16, 8, diffuse_brdf(0.2, 0.1, 0.05))));
}

}  // namespace
}  // namespace lumitexel
