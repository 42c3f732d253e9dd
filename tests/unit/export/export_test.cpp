#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "processing/export/export_model.h"
#include "processing/export/refit.h"
#include "processing/image/raster_file.h"
#include "rig/whole_file.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/export/reflected_energy.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

Brdf with_lobe(BrdfFamily family, double diffuse, double log_strength, double log_shape) {
  Brdf brdf = diffuse_brdf(diffuse, 0.7 * diffuse, 0.4 * diffuse);
  brdf.family = family;
  Lobe lobe;
  lobe.log_strength = log_strength;
  lobe.log_shape = log_shape;
  brdf.lobes.push_back({lobe, lobe, lobe});
  return brdf;
}

GltfMaterial refitted(const Brdf& brdf) {
  const float one[] = {1.0f};
  return MaterialRefit({brdf}).fit(one);
}

TEST(Export, AGgxBrdfComesBackAsItself) {
  for (const double roughness : {0.25, 0.5, 0.75}) {
    const Brdf brdf = with_lobe(BrdfFamily::Ggx, 0.1, std::log(0.3), 2.0 * std::log(roughness));
    const GltfMaterial material = refitted(brdf);
    // The material's diffuse light falls with (1 - cos_d)^5, the BRDF's does not: that much is left to share out.
    EXPECT_NEAR(material.roughness, roughness, 1.5 / MaterialRefit::kRoughnesses);
    EXPECT_NEAR(material.f0[1], 0.3, 0.01);
    EXPECT_NEAR(material.base[0], std::numbers::pi * 0.1 / 0.7, 0.02);
  }
}

struct Energies {
  double was = 0, is = 0;
};

// The mean over rings of equal area of a sphere's picture, from sin^2 of the viewer's angle `from` to `to`.
Energies mean_energies(const Brdf& brdf, const GltfMaterial& material, double from, double to) {
  constexpr int kRings = 4;
  Energies mean;
  for (int i = 0; i < kRings; ++i) {
    const double angle = std::asin(std::sqrt(from + (to - from) * (i + 0.5) / kRings));
    mean.was += reflected_energy([&](const LobeGeometry& g) { return evaluate(brdf, 0, g); }, angle) / kRings;
    mean.is += reflected_energy([&](const LobeGeometry& g) { return evaluate(material, g)[0]; }, angle) / kRings;
  }
  return mean;
}

// What is guaranteed: a Lafortune lobe's light comes back within 5 % as a mean over the viewer's angles that are fitted, up to 45 degrees.
// Beyond, where a Lafortune lobe dims and a microfacet lobe grows, there is too much of it; how much at most is stated and held, too.
TEST(Export, ALafortuneLobeKeepsItsEnergyWhereItIsFittedAndItsExcessBeyondIsBounded) {
  constexpr double kWithinFitted = 0.05, kMostExcessBeyond = 0.30, kMostExcessOverall = 0.15;  // 0.25 to 0.27, 0.09 to 0.13
  for (const double exponent : {10.0, 50.0, 300.0}) {
    const double peak = 0.3 * (exponent + 2.0) / (2.0 * std::numbers::pi);  // about 0.3 of the light
    const Brdf brdf = with_lobe(BrdfFamily::Lafortune, 0.08, std::log(peak), std::log(exponent));
    const GltfMaterial material = refitted(brdf);
    const Energies fitted = mean_energies(brdf, material, 0.0, 0.5), beyond = mean_energies(brdf, material, 0.5, 1.0);
    EXPECT_NEAR(fitted.is, fitted.was, kWithinFitted * fitted.was) << exponent;
    EXPECT_LT(beyond.is - beyond.was, kMostExcessBeyond * beyond.was) << exponent;
    EXPECT_LT(fitted.is + beyond.is - fitted.was - beyond.was, kMostExcessOverall * (fitted.was + beyond.was)) << exponent;
  }
}

TEST(Export, EnergyIsNeverOverOne) {
  const Brdf brdf = with_lobe(BrdfFamily::Ggx, 0.6, std::log(0.95), 2.0 * std::log(0.4));  // gives back more than it gets
  const GltfMaterial material = refitted(brdf);
  for (const double angle : {0.1, 0.7, 1.2}) {
    EXPECT_LE(reflected_energy([&](const LobeGeometry& g) { return evaluate(material, g)[0]; }, angle), 1.002) << angle;  // the rule's own error
  }
}

TEST(Export, AMixtureIsFittedAsAWhole) {
  const Brdf dull = diffuse_brdf(0.2, 0.2, 0.2), shiny = with_lobe(BrdfFamily::Ggx, 0.0, std::log(0.4), 2.0 * std::log(0.5));
  const float half[] = {0.5f, 0.5f};
  const GltfMaterial material = MaterialRefit({dull, shiny}).fit(half);
  EXPECT_NEAR(material.roughness, 0.5, 0.03);
  EXPECT_NEAR(material.f0[0], 0.2, 0.02);
}

TEST(Export, ASurfaceWithoutHighlightsHasNoneAtGrazingEither) {
  const GltfMaterial matte = refitted(diffuse_brdf(0.2, 0.1, 0.05));
  EXPECT_NEAR(matte.specular, 0.0, 1e-9);
  EXPECT_NEAR(matte.base[1], 0.1 * std::numbers::pi, 1e-6);
  const Eigen::Vector3d wi(std::sin(1.5), 0, std::cos(1.5)), wo(-std::sin(1.5), 0, std::cos(1.5));
  EXPECT_NEAR(evaluate(matte, lobe_geometry(Eigen::Vector3d::UnitZ(), wi, wo))[0], 0.2, 1e-6);
}

TEST(Export, HighlightsRiseAtGrazingWhereTheBrdfsDoAndNotElsewhere) {
  EXPECT_EQ(refitted(with_lobe(BrdfFamily::Ggx, 0.1, std::log(0.02), 2.0 * std::log(0.5))).specular, 1.0);
  const GltfMaterial steady = refitted(with_lobe(BrdfFamily::Lafortune, 0.1, std::log(3.0), std::log(50.0)));
  EXPECT_GT(steady.f0[0], 0.01);
  EXPECT_DOUBLE_EQ(steady.specular, *std::max_element(steady.f0.begin(), steady.f0.end()));
}

TEST(Export, TexturesGiveBackAFaintHighlightWithinTheirSteps) {
  // F0 of some 3 % that does not rise: 8 codes of the factor alone would leave it 6 % off.
  const Model model = model_of(square_mesh(), 4, 4, with_lobe(BrdfFamily::Lafortune, 0.1, std::log(0.3), std::log(50.0)));
  NoProgress quiet;
  const GltfMaterial fitted = refitted(model.materials.front().basis.front()), texel = decoded_texel(refit_maps(model, quiet), 1, 1);
  EXPECT_LT(fitted.f0[0], 0.06);
  EXPECT_LT(fitted.specular, 0.06);
  EXPECT_NEAR(texel.f0[0], fitted.f0[0], 0.01 * fitted.f0[0]);
  EXPECT_NEAR(texel.specular, fitted.specular, 1.0 / 255.0);
}

TEST(Export, TexturesHoldTheNearestMaterialBeyondTheSeam) {
  Model model = model_of(square_mesh(), 4, 1, diffuse_brdf(0.1, 0.1, 0.1));
  model.material = {0, Model::kNoMaterial, Model::kNoMaterial, Model::kNoMaterial};
  NoProgress quiet;
  const ExportedMaps maps = refit_maps(model, quiet);
  EXPECT_GT(maps.base.at(0, 0), 0.4f);
  EXPECT_EQ(maps.base.at(3, 0), maps.base.at(0, 0));
}

TEST(Export, GltfStatesTheLossAndItsBufferIsWhole) {
  const TemporaryFolder folder;
  const std::filesystem::path out = folder.path() / "gltf";
  const Model model = model_of(sphere_mesh(40, 20), 4, 4, with_lobe(BrdfFamily::Ggx, 0.1, std::log(0.2), 2.0 * std::log(0.5)));
  NoProgress quiet;
  const ConversionLoss loss = export_model(model, ExportFormat::Gltf, out, quiet);
  EXPECT_GT(loss.error.psnr_db, 38.0);  // 8 bits and the diffuse light's fall alone stand between the two
  std::ifstream file(out / "model.gltf");
  const nlohmann::json document = nlohmann::json::parse(file);
  EXPECT_EQ(document.at("asset").at("extras").at("conversion_loss").at("psnr_db"), loss.error.psnr_db);
  EXPECT_EQ(document.at("buffers").at(0).at("byteLength"), std::filesystem::file_size(out / "model.bin"));
  EXPECT_EQ(document.at("accessors").at(0).at("count"), model.mesh.positions.size());
  EXPECT_EQ(read_raster(out / "base.png").code_values.at(1, 1, 0), std::round(255.0f * refit_maps(model, quiet).base.at(1, 1, 0)));
  EXPECT_THROW(export_model(model, ExportFormat::Gltf, out, quiet), BadInput) << "nothing is overwritten";
}

// The session's z is up, glTF's y.
TEST(Export, AGltfSceneStandsUpright) {
  const TemporaryFolder folder;
  const Model model = model_of(sphere_mesh(8, 4), 4, 4, with_lobe(BrdfFamily::Ggx, 0.1, std::log(0.2), 2.0 * std::log(0.5)));
  NoProgress quiet;
  export_model(model, ExportFormat::Gltf, folder.path() / "gltf", quiet);
  std::ifstream file(folder.path() / "gltf" / "model.gltf");
  const auto turn = nlohmann::json::parse(file).at("nodes").at(0).at("rotation").get<std::array<double, 4>>();
  const Eigen::Quaterniond rotation(turn[3], turn[0], turn[1], turn[2]);
  EXPECT_TRUE((rotation * Eigen::Vector3d::UnitZ()).isApprox(Eigen::Vector3d::UnitY(), 1e-12));
  EXPECT_TRUE((rotation * Eigen::Vector3d::UnitX()).isApprox(Eigen::Vector3d::UnitX(), 1e-12));
}

class StatedLoss : public testing::TestWithParam<std::pair<ExportFormat, const char*>> {};

TEST_P(StatedLoss, StandsInTheFile) {
  const TemporaryFolder folder;
  NoProgress quiet;
  const Model model = model_of(sphere_mesh(12, 6), 4, 4, with_lobe(BrdfFamily::Lafortune, 0.1, std::log(2.0), std::log(50.0)));
  const ConversionLoss loss = export_model(model, GetParam().first, folder / "out", quiet);
  std::string text = read_whole_file(folder / "out" / GetParam().second);
  text.erase(std::remove(text.begin(), text.end(), ' '), text.end());  // JSON with and without blanks
  EXPECT_NE(text.find("\"psnr_db\":" + nlohmann::json(loss.error.psnr_db).dump()), std::string::npos) << text.substr(0, 2000);
}

INSTANTIATE_TEST_SUITE_P(Formats, StatedLoss,
                         testing::Values(std::pair(ExportFormat::Blender, "scene.json"), std::pair(ExportFormat::Materialx, "model.mtlx"),
                                         std::pair(ExportFormat::Mitsuba, "scene.xml"), std::pair(ExportFormat::Maps, "maps.json")));

// Fails as a full disk would, when the textures are about to be written.
struct FailingProgress final : Progress {
  void begin(const std::string& stage, std::int64_t, const std::string&) override {
    stages.push_back(stage);
    if (stages.size() == 2) throw Error("no room");
  }
  void update(std::int64_t) override {}
  std::vector<std::string> stages;
};

TEST(Export, WhatWasNotFinishedLeavesNothing) {
  const TemporaryFolder folder;
  const Model model = model_of(square_mesh(), 4, 4, diffuse_brdf(0.1, 0.1, 0.1));
  for (const char* name : {"new", "below/new", "empty"}) {
    if (std::string(name) == "empty") std::filesystem::create_directory(folder / name);
    FailingProgress failing;
    EXPECT_THROW(export_model(model, ExportFormat::Gltf, folder / name, failing), Error);
    EXPECT_EQ(failing.stages.size(), 2u) << "fails where it should";
  }
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1) << "the empty folder that was there";
  EXPECT_TRUE(std::filesystem::is_empty(folder / "empty"));
  NoProgress quiet;
  export_model(model, ExportFormat::Gltf, folder / "empty", quiet);
  EXPECT_TRUE(std::filesystem::exists(folder / "empty" / "model.gltf"));
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 1);
}

TEST(Export, AFolderThatCannotBeMadeIsNamedBeforeTheWork) {
  const TemporaryFolder folder;
  write_whole_file(folder / "file", "");
  NoProgress quiet;
  const Model model = model_of(square_mesh(), 4, 4, diffuse_brdf(0.1, 0.1, 0.1));
  EXPECT_BAD_INPUT(export_model(model, ExportFormat::Gltf, folder / "file/below", quiet), "below", "a folder that can be written to");
  EXPECT_BAD_INPUT(export_format_from_string("ply"), "ply", "mitsuba");
}

}  // namespace
}  // namespace lumitexel
