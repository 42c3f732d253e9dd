#include "processing/export/exported_normals.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>
#include <nlohmann/json.hpp>

#include "processing/export/export_model.h"
#include "processing/export/tangent_frame.h"
#include "processing/image/exr_file.h"
#include "processing/image/raster_file.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

// A normal of its own in every texel, up to some 30 degrees off the sphere's.
Model rippled_sphere(int width, int height) {
  Model model = model_of(sphere_mesh(40, 20), width, height, diffuse_brdf(0.1, 0.1, 0.1));
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double longitude = 2.0 * std::numbers::pi * (x + 0.5) / width, latitude = std::numbers::pi * (0.5 - (y + 0.5) / height);
      const Eigen::Vector3d smooth(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude));
      const Eigen::Vector3d normal = (smooth + 0.3 * Eigen::Vector3d(std::sin(0.5 * x), std::cos(0.3 * y), std::sin(0.2 * x + 0.4 * y))).normalized();
      for (int k = 0; k < 3; ++k) model.normal.at(x, y, k) = static_cast<float>(normal[k]);
    }
  }
  return model;
}

double angle(const Eigen::Vector3d& a, const Eigen::Vector3d& b) { return std::atan2(a.cross(b).norm(), a.dot(b)); }

TEST(ExportedNormals, ATextureGivesTheWorldsNormalBackWithinItsSteps) {
  const Model model = rippled_sphere(80, 40);
  const ModelSurface surface(model);
  const ExportedNormals normals = export_normals(model);
  const Image coded = coded_normals(normals.tangent);
  const std::vector<Eigen::Vector4d> tangents = vertex_tangents(model.mesh);
  // Half a step of 2/255 in each of three components, and what a centre that is met a hair beside itself changes.
  const double tolerance_rad = std::sqrt(3.0) / 255.0 + 1e-4;
  int met = 0;
  for (int y = 4; y < 36; ++y) {  // the pole's triangles are slivers of the texture
    for (int x = 0; x < 80; ++x) {
      // The ray through a texel's centre on the facets: where it is met, its own frame is asked, as a renderer does.
      const double u = (x + 0.5) / 80, v = 1.0 - (y + 0.5) / 40;
      const double longitude = 2.0 * std::numbers::pi * u, latitude = std::numbers::pi * (v - 0.5);
      const Eigen::Vector3d out(std::cos(latitude) * std::cos(longitude), std::cos(latitude) * std::sin(longitude), std::sin(latitude));
      const auto point = surface.trace(3.0 * out, -out);
      ASSERT_TRUE(point);
      const Eigen::Matrix3d frame = tangent_frame(model.mesh, tangents, point->triangle, point->u, point->v);
      const Eigen::Vector3d back = (frame * decoded_normal(coded, x, y)).normalized();
      const Eigen::Vector3d own(model.normal.at(x, y, 0), model.normal.at(x, y, 1), model.normal.at(x, y, 2));
      // Facets and sphere place the same u, v up to 0.08 / 4 of a step apart: the frame turns by no more than that.
      EXPECT_LT(angle(back, own), tolerance_rad + 0.01) << x << " " << y;
      ++met;
    }
  }
  EXPECT_EQ(met, 80 * 32);
}

TEST(ExportedNormals, TangentsRunAlongGrowingUAndBitangentsAlongGrowingV) {
  const Mesh mesh = sphere_mesh(40, 20);
  const std::vector<Eigen::Vector4d> tangents = vertex_tangents(mesh);
  const std::size_t vertex = 12 * 41 + 5;
  const Eigen::Vector3d n = mesh.normals[vertex], east = Eigen::Vector3d::UnitZ().cross(n).normalized();
  EXPECT_LT(angle(tangents[vertex].head<3>(), east), 0.01);
  const std::uint32_t triangle = 12 * 2 * 40 + 10 - 40;  // of that band
  const Eigen::Matrix3d frame = tangent_frame(mesh, tangents, triangle, 0.3, 0.3);
  EXPECT_GT(frame.col(1).z(), 0.9) << "green is up in the picture, north on the sphere";
  EXPECT_LT(angle(frame.col(1), frame.col(2).cross(frame.col(0))), 1e-9);
  for (std::size_t v = 0; v < tangents.size(); ++v) {
    EXPECT_NEAR(tangents[v].head<3>().norm(), 1.0, 1e-12);
    EXPECT_NEAR(tangents[v].head<3>().dot(mesh.normals[v]), 0.0, 1e-12);
  }
  Mesh mirrored = mesh;
  for (Eigen::Vector2d& uv : mirrored.texcoords) uv.x() = 1.0 - uv.x();
  EXPECT_EQ(vertex_tangents(mirrored)[vertex].w(), -tangents[vertex].w());
  EXPECT_LT(angle(vertex_tangents(mirrored)[vertex].head<3>(), -east), 0.01);
}

TEST(ExportedNormals, WithoutNormalsOfTheirOwnTexelsSayTheMeshs) {
  Model model = model_of(sphere_mesh(40, 20), 80, 40, diffuse_brdf(0.1, 0.1, 0.1));
  const ExportedNormals normals = export_normals(model);
  EXPECT_EQ(normals.tilt_rms_rad, 0.0);
  EXPECT_EQ(normals.tangent.at(3, 7, 2), 1.0f);
  EXPECT_NEAR(normals.world.at(20, 20, 1), 1.0, 0.01);  // a quarter turn from +x
  NoProgress quiet;
  EXPECT_EQ(refit_maps(model, quiet).normal.channels, 0) << "a texture that says nothing is not written";
}

TEST(ExportedNormals, ANormalBelowTheHorizonIsLaidOnIt) {
  const Eigen::Vector3d laid = in_frame(Eigen::Matrix3d::Identity(), Eigen::Vector3d(0.6, 0.0, -0.8));
  EXPECT_NEAR(laid.x(), 1.0, 1e-12);
  EXPECT_EQ(in_frame(Eigen::Matrix3d::Identity(), -Eigen::Vector3d::UnitZ()), Eigen::Vector3d::UnitZ().eval());
}

TEST(ExportedNormals, GltfCarriesThemWithTangentsAndTheRenderingKeepsThem) {
  const TemporaryFolder folder;
  NoProgress quiet;
  const Model model = rippled_sphere(80, 40);
  const ConversionLoss loss = export_model(model, ExportFormat::Gltf, folder / "gltf", quiet);
  // Ours blends shaded texels, a normal texture blends normals: that is left. The mesh's own normals give 18 dB.
  EXPECT_GT(loss.error.psnr_db, 30.0);
  std::ifstream file(folder / "gltf/model.gltf");
  const nlohmann::json document = nlohmann::json::parse(file);
  const auto& accessor = document.at("accessors").at(document.at("meshes").at(0).at("primitives").at(0).at("attributes").at("TANGENT").get<std::size_t>());
  EXPECT_EQ(accessor.at("type"), "VEC4");
  EXPECT_EQ(accessor.at("count"), model.mesh.positions.size());
  const auto texture = document.at("materials").at(0).at("normalTexture").at("index").get<std::size_t>();
  EXPECT_EQ(document.at("images").at(texture).at("uri"), "normal.png");
  EXPECT_EQ(read_raster(folder / "gltf/normal.png").code_values.channels, 3);
}

TEST(ExportedMaps, EveryMapIsNamedAndHoldsItsNumbers) {
  const TemporaryFolder folder;
  NoProgress quiet;
  Model model = rippled_sphere(8, 4);
  model.material[0] = Model::kNoMaterial;
  model.weights = Image(8, 4, 2, 2.0f);
  model.materials.front().basis.push_back(diffuse_brdf(0, 0, 0));
  export_model(model, ExportFormat::Maps, folder / "maps", quiet);
  std::ifstream file(folder / "maps/maps.json");
  const nlohmann::json document = nlohmann::json::parse(file);
  std::vector<std::string> names;
  for (const auto& map : document.at("maps")) {
    names.push_back(map.at("name"));
    const RasterImage png = read_raster(folder / ("maps/" + map.at("png").get<std::string>()));
    const Image exr = read_exr_colour(folder / ("maps/" + map.at("exr").get<std::string>()));
    EXPECT_EQ(exr.channels, map.at("channels")) << names.back();
    EXPECT_EQ(png.code_values.width, 8);
    if (map.at("png_colour_space") == "sRGB (IEC 61966-2-1)") {
      EXPECT_NEAR(srgb_decoded(png.code_values.at(3, 2) / 255.0), exr.at(3, 2), 0.005) << names.back();
      continue;
    }
    // Linear: what maps.json says of the codes has to give the EXR's number within half a step.
    const double low = map.at("png_zero"), step = (map.at("png_full_scale").get<double>() - low) / 255.0;
    EXPECT_NEAR(low + step * png.code_values.at(3, 2), exr.at(3, 2), 0.5 * step + 1e-6) << names.back();
  }
  const std::vector<std::string> expected = {"base", "specular", "specular_factor", "roughness", "metallic", "normal_world", "normal_tangent",
                                             "cluster", "weight_0", "weight_1", "uncertainty", "samples"};
  EXPECT_EQ(names, expected);
  EXPECT_EQ(read_exr_colour(folder / "maps/cluster.exr").at(0, 0), 65535.0f);
  EXPECT_NEAR(read_exr_colour(folder / "maps/base.exr").at(3, 2), 2.0 * std::numbers::pi * 0.1, 0.01);
  EXPECT_EQ(document.at("conversion_loss").at("views"), 12);
}

}  // namespace
}  // namespace lumitexel
