// The exported scene was never loaded by Mitsuba itself: what is tested is the XML, its files, every name in it against the plugins' reference
// pages, and the published formulas on what the textures say.
#include "processing/export/mitsuba_scene.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <numbers>

#include "processing/export/export_model.h"
#include "processing/export/refit.h"
#include "processing/export/tangent_frame.h"
#include "processing/image/exr_file.h"
#include "processing/image/raster_file.h"
#include "processing/surface/mesh_file.h"
#include "rig/whole_file.h"
#include "tests/unit/export/reflected_energy.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

// Names and types: Mitsuba 3's plugin reference (mitsuba.readthedocs.io: integrators, sensors, films, reconstruction filters, samplers,
// emitters, shapes, bsdfs, textures) and its scene XML format, version 3.7.1. Only what the scene uses is listed.
constexpr const char* kCheck = R"PY(
import json, os, sys, xml.etree.ElementTree as tree
folder = sys.argv[1]
KNOWN = {
    ("integrator", "direct"): {},
    ("sensor", "perspective"): {"fov_axis": "string", "fov": "float", "near_clip": "float", "far_clip": "float", "to_world": "transform"},
    ("sampler", "independent"): {"sample_count": "integer"},
    ("film", "hdrfilm"): {"width": "integer", "height": "integer", "file_format": "string", "pixel_format": "string", "component_format": "string"},
    ("rfilter", "box"): {},
    ("emitter", "point"): {"position": "point", "intensity": "rgb"},
    ("shape", "obj"): {"filename": "string", "flip_tex_coords": "boolean"},
    ("bsdf", "normalmap"): {"normalmap": "texture", "use_shadowing_function": "boolean"},
    ("bsdf", "blendbsdf"): {"weight": "texture"},
    ("bsdf", "diffuse"): {"reflectance": "texture"},
    ("bsdf", "roughconductor"): {"material": "string", "distribution": "string", "alpha": "texture", "specular_reflectance": "texture"},
    ("texture", "bitmap"): {"filename": "string", "wrap_mode": "string", "raw": "boolean"},
}
NESTED = {"scene": {"integrator", "sensor", "emitter", "shape"}, "perspective": {"sampler", "film"}, "hdrfilm": {"rfilter"}, "obj": {"bsdf"},
          "normalmap": {"bsdf"}, "blendbsdf": {"bsdf"}}
RAW = {"weight.png": "true", "alpha.exr": "true", "normal.png": "true", "base.png": "false", "specular.png": "false"}

def check(node, kind):
    terms = KNOWN[(node.tag, kind)] if node.tag != "scene" else {}
    for child in node:
        if child.get("name") in terms:
            assert child.tag == terms[child.get("name")], (kind, child.attrib)
        else:
            assert child.tag in NESTED.get(kind, ()), (kind, child.tag, child.attrib)
        if child.tag == "transform":
            assert len(child.find("matrix").get("value").split()) == 16
        elif child.get("type"):
            check(child, child.get("type"))
        if child.get("name") == "filename":
            assert os.path.isfile(os.path.join(folder, child.get("value"))), child.attrib
            if kind == "bitmap":
                assert node.find("boolean[@name='raw']").get("value") == RAW[child.get("value")]

root = tree.parse(os.path.join(folder, "scene.xml")).getroot()
assert root.tag == "scene" and root.get("version") == "3.0.0"
check(root, "scene")
blend = next(node for node in root.iter("bsdf") if node.get("type") == "blendbsdf")
assert [(part.get("name"), part.get("type")) for part in blend.findall("bsdf")] == [("bsdf_0", "diffuse"), ("bsdf_1", "roughconductor")]
text = open(os.path.join(folder, "scene.xml")).read()
assert json.loads(text.split("conversion_loss: ")[1].split("\n")[0])["views"] == 12
)PY";

Brdf lafortune() {
  Brdf brdf = diffuse_brdf(0.12, 0.08, 0.04);
  Lobe red, green;
  red.log_strength = std::log(1.5);
  green.log_strength = std::log(0.9);
  red.log_shape = green.log_shape = std::log(60.0);
  brdf.lobes.push_back({red, green, green});
  return brdf;
}

GltfMaterial refitted(const Brdf& brdf) {
  const float one[] = {1.0f};
  return MaterialRefit({brdf}, MaterialForm::Mitsuba).fit(one);
}

// roughconductor with distribution ggx and eta 0, k 1 (F = 1), as its reference page and Walter et al. 2007 have it, from vectors.
double highlight(double alpha, const Eigen::Vector3d& wi, const Eigen::Vector3d& wo) {
  const Eigen::Vector3d h = (wi + wo).normalized();
  const double e = (h.x() * h.x() + h.y() * h.y()) / (alpha * alpha) + h.z() * h.z();
  const auto g1 = [&](const Eigen::Vector3d& w) {
    return 2.0 / (1.0 + std::sqrt(1.0 + alpha * alpha * (w.x() * w.x() + w.y() * w.y()) / (w.z() * w.z())));
  };
  return g1(wi) * g1(wo) / (std::numbers::pi * alpha * alpha * e * e * 4.0 * wi.z() * wo.z());
}

struct Files {
  TemporaryFolder folder;
  std::filesystem::path at;
  ConversionLoss loss;
  explicit Files(const Model& model) : at(folder / "mitsuba") {
    NoProgress quiet;
    loss = export_model(model, ExportFormat::Mitsuba, at, quiet);
  }
};

void expect_known(const Model& model) {
  if (std::system("command -v python3 >/dev/null") != 0) GTEST_SKIP() << "PYTHON MISSING: scene.xml is not parsed, so this is not tested";
  const Files files(model);
  write_whole_file(files.folder / "check.py", kCheck);
  EXPECT_EQ(std::system(("python3 " + (files.folder / "check.py").string() + " " + files.at.string()).c_str()), 0)
      << read_whole_file(files.at / "scene.xml");
  EXPECT_EQ(read_mesh(files.at / "mesh.obj").triangles.size(), model.mesh.triangles.size());
}

TEST(MitsubaScene, EveryNameIsOneOfMitsubasAndEveryFileIsThere) { expect_known(model_of(sphere_mesh(24, 12), 16, 8, lafortune())); }

TEST(MitsubaScene, AlsoWithNormals) {
  expect_known(with_own_normals(model_of(sphere_mesh(24, 12), 16, 8, lafortune())));
}

TEST(MitsubaScene, TexturesInThePublishedFormulasGiveTheRefittedMaterial) {
  const Files files(model_of(sphere_mesh(24, 12), 16, 8, lafortune()));
  const auto code = [&](const char* file, int c) { return read_raster(files.at / file).code_values.at(3, 4, c) / 255.0; };
  const double weight = code("weight.png", 0), alpha = read_exr_colour(files.at / "alpha.exr").at(3, 4);
  const GltfMaterial material = refitted(lafortune());
  for (const double tilt : {0.0, 0.1, 0.3, 0.9}) {
    const Eigen::Vector3d wo(std::sin(0.4), 0, std::cos(0.4)), wi(std::sin(tilt - 0.4), 0.2 * tilt, std::cos(tilt - 0.4));
    const LobeGeometry geometry = lobe_geometry(Eigen::Vector3d::UnitZ(), wi.normalized(), wo);
    const ChannelValues expected = evaluate(MaterialForm::Mitsuba, material, geometry);
    for (int c = 0; c < 3; ++c) {
      const double value = (1.0 - weight) * srgb_decoded(code("base.png", c)) / std::numbers::pi +
                           weight * srgb_decoded(code("specular.png", c)) * highlight(alpha, wi.normalized(), wo);
      // 8 bits: half a step of sRGB is up to 1 % of a dark colour, and half a step of roughness 0.5 % of it, fourfold in the peak.
      EXPECT_NEAR(value, expected[static_cast<std::size_t>(c)], 0.03 * expected[static_cast<std::size_t>(c)]) << tilt << " " << c;
    }
  }
}

TEST(MitsubaScene, LosesNothingOfAMaterialThatItHas) {
  const Files files(model_of(sphere_mesh(80, 40), 16, 8, diffuse_brdf(0.2, 0.1, 0.05)));
  EXPECT_GT(files.loss.error.psnr_db, 45.0);  // 8 bits of sRGB
}

TEST(MitsubaScene, AWhiteHighlightGivesBackNoMoreThanItGets) {
  GltfMaterial white;
  white.f0 = {1.0, 1.0, 1.0};
  white.roughness = 0.3;  // rougher ones lose more to the horizon and to the other facets
  const double energy =
      reflected_energy([&](const LobeGeometry& geometry) { return evaluate(MaterialForm::Mitsuba, white, geometry)[0]; }, 0.7);
  EXPECT_LE(energy, 1.0);
  EXPECT_GT(energy, 0.96);
}

TEST(MitsubaScene, NormalsStandInTheTrianglesFrame) {
  const Mesh mesh = sphere_mesh(40, 20);
  const std::uint32_t triangle = 12 * 2 * 40 + 10 - 40;
  const Eigen::Matrix3d frame = triangle_frame(mesh, triangle, 0.3, 0.3);
  EXPECT_LT((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm(), 1e-9);
  EXPECT_GT(frame.col(1).z(), 0.9) << "north, where v grows";
  const auto& [a, b, c] = mesh.triangles[triangle];
  const Eigen::Vector3d across = (mesh.positions[b] - mesh.positions[a]).cross(mesh.positions[c] - mesh.positions[a]);
  EXPECT_NEAR(across.normalized().dot(frame.col(2)), 1.0, 0.01);
  Mesh mirrored = mesh;
  for (Eigen::Vector2d& uv : mirrored.texcoords) uv.x() = 1.0 - uv.x();
  EXPECT_LT(triangle_frame(mirrored, triangle, 0.3, 0.3).col(1).z(), -0.9) << "whatever the handedness, cross(normal, tangent)";
}

}  // namespace
}  // namespace lumitexel
