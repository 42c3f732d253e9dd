#include "processing/model/model_file.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>
#include <random>

#include "processing/image/exr_file.h"
#include "processing/model/model_hashes.h"
#include "processing/surface/mesh_file.h"
#include "rig/whole_file.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

Brdf odd_brdf(std::mt19937& random) {
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  Brdf brdf = diffuse_brdf(unit(random), unit(random), unit(random));
  auto& lobe = brdf.lobes.emplace_back();
  for (auto& channel : lobe) channel = {10.0 * unit(random) - 5.0, 15.0 * unit(random) - 4.0, unit(random)};
  lobe[1].log_strength = -std::numeric_limits<double>::infinity();  // switched off
  lobe[2].log_strength = 800.0;                                     // its exponential overflows
  return brdf;
}

// Two materials with five and two bases, so that two weight files are needed, and numbers that no short decimal holds.
Model odd_model() {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  Model model = model_of(sphere_mesh(8, 4), 6, 5, odd_brdf(random));
  model.materials = {{odd_brdf(random), {}}, {odd_brdf(random), {}}};
  for (int k = 0; k < 5; ++k) model.materials[0].basis.push_back(odd_brdf(random));
  for (int k = 0; k < 2; ++k) model.materials[1].basis.push_back(odd_brdf(random));
  model.weights = Image(6, 5, 5);
  for (float& value : model.weights.data) value = unit(random);
  for (ModelMaterial& material : model.materials) {
    for (std::size_t k = 0; k < material.basis.size(); ++k) material.projection_basis.push_back(odd_brdf(random));
  }
  model.projection_weights = Image(6, 5, 5);
  for (float& value : model.projection_weights.data) value = unit(random);
  const double unknown = std::numeric_limits<double>::quiet_NaN();
  model.materials[0].sigma = BrdfSigma{{0.1, unknown, 1.0 / 3.0}, {{LobeSigma{0.2, unknown, 0.01}, LobeSigma{unknown, 1e-300, 2.0}, LobeSigma{}}}};
  ErrorModel error(0.1, 1.0 / 300.0);
  error.freedom = 2.5;
  error.independence = 1.0 / 7.0;
  ChannelMatrix correlation(3, 3);
  correlation << 1.0, 0.9, 0.7, 0.9, 1.1, 0.6, 0.7, 0.6, 1.0;
  error.set_correlation(correlation);
  model.materials[0].error = error;
  model.outliers_csv = "view,reason\na,dark\n";
  for (float& value : model.uncertainty.data) value = unit(random);
  for (std::size_t t = 0; t < model.material.size(); ++t) {
    model.material[t] = static_cast<std::int16_t>(static_cast<int>(t % 3) - 1);
    const Eigen::Vector3f normal = Eigen::Vector3f(unit(random), unit(random), 0.1f).normalized();
    std::copy(normal.data(), normal.data() + 3, &model.normal.data[3 * t]);
  }
  return model;
}

// The same after normals were fitted and light between surfaces was taken out: its earlier stages with other materials, labels and weights.
Model model_on_fitted_normals() {
  std::mt19937 random(8);
  std::uniform_real_distribution<float> unit(0.0f, 1.0f);
  Model model = odd_model();
  ReflectanceLayer before{{{odd_brdf(random), {odd_brdf(random), odd_brdf(random)}, {}}}, std::vector<std::int16_t>(30, 0), Image(6, 5, 2), {}};
  for (float& value : before.weights.data) value = unit(random);
  before.material[3] = Model::kNoMaterial;
  ErrorModel outlying(0.05, 0.002);  // two normal distributions, channels apart
  outlying.freedom = ErrorModel::kGaussian;
  outlying.outlier_share = 0.02;
  outlying.outlier_scale = 20.0 / 3.0;
  before.materials[0].error = outlying;
  model.before_normals = before;
  model.normal_sigma = Image(6, 5, 1);
  for (float& value : model.normal_sigma.data) value = unit(random);
  model.indirect = Image(6, 5, 2);
  for (float& value : model.indirect.data) value = unit(random);
  model.indirect_bounces = 2;
  return model;
}

void expect_equal(const Brdf& a, const Brdf& b) {
  EXPECT_EQ(a.channels, b.channels);
  EXPECT_EQ(a.diffuse, b.diffuse);
  ASSERT_EQ(a.lobes.size(), b.lobes.size());
  for (std::size_t l = 0; l < a.lobes.size(); ++l) {
    for (std::size_t c = 0; c < kMaxChannels; ++c) {
      EXPECT_EQ(a.lobes[l][c].log_strength, b.lobes[l][c].log_strength);
      EXPECT_EQ(a.lobes[l][c].aim, b.lobes[l][c].aim);
      EXPECT_EQ(a.lobes[l][c].log_shape, b.lobes[l][c].log_shape);
    }
  }
}

void expect_equal(const std::optional<BrdfSigma>& a, const std::optional<BrdfSigma>& b) {
  const auto same = [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); };
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  for (std::size_t c = 0; c < kMaxChannels; ++c) EXPECT_TRUE(same(a->diffuse[c], b->diffuse[c]));
  ASSERT_EQ(a->lobes.size(), b->lobes.size());
  for (std::size_t l = 0; l < a->lobes.size(); ++l) {
    for (std::size_t c = 0; c < kMaxChannels; ++c) {
      const LobeSigma &s = a->lobes[l][c], &t = b->lobes[l][c];
      EXPECT_TRUE(same(s.log_strength, t.log_strength) && same(s.log_shape, t.log_shape) && same(s.aim, t.aim)) << l << " " << c;
    }
  }
}

// What a file holds of how channels go together is the matrix itself, of which its root is made once more.
constexpr double kRootOfAMatrix = 1e-13;

void expect_equal(const std::optional<ErrorModel>& a, const std::optional<ErrorModel>& b) {
  ASSERT_EQ(a.has_value(), b.has_value());
  if (!a) return;
  EXPECT_EQ(a->relative, b->relative);
  EXPECT_EQ(a->floor, b->floor);
  EXPECT_EQ(a->freedom, b->freedom);
  EXPECT_EQ(a->outlier_share, b->outlier_share);
  EXPECT_EQ(a->outlier_scale, b->outlier_scale);
  EXPECT_EQ(a->independence, b->independence);
  ASSERT_EQ(a->whitening().size(), b->whitening().size());
  if (a->whitening().size() > 0) {
    EXPECT_LT((a->whitening() - b->whitening()).cwiseAbs().maxCoeff(), kRootOfAMatrix);
  }
  EXPECT_NEAR(a->log_determinant(), b->log_determinant(), kRootOfAMatrix);
}

void expect_equal(const std::vector<ModelMaterial>& a, const std::vector<ModelMaterial>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t m = 0; m < a.size(); ++m) {
    expect_equal(a[m].brdf, b[m].brdf);
    expect_equal(a[m].sigma, b[m].sigma);
    expect_equal(a[m].error, b[m].error);
    ASSERT_EQ(a[m].basis.size(), b[m].basis.size());
    ASSERT_EQ(a[m].projection_basis.size(), b[m].projection_basis.size());
    for (std::size_t k = 0; k < a[m].basis.size(); ++k) expect_equal(a[m].basis[k], b[m].basis[k]);
    for (std::size_t k = 0; k < a[m].projection_basis.size(); ++k) expect_equal(a[m].projection_basis[k], b[m].projection_basis[k]);
  }
}

void expect_equal(const Model& a, const Model& b) {
  EXPECT_EQ(a.channels, b.channels);
  EXPECT_EQ(a.width, b.width);
  EXPECT_EQ(a.height, b.height);
  expect_equal(a.single, b.single);
  expect_equal(a.materials, b.materials);
  EXPECT_EQ(a.material, b.material);
  EXPECT_EQ(a.weights.data, b.weights.data);
  EXPECT_EQ(a.projection_weights.data, b.projection_weights.data);
  EXPECT_EQ(a.outliers_csv, b.outliers_csv);
  EXPECT_EQ(a.normal.data, b.normal.data);
  EXPECT_EQ(a.uncertainty.data, b.uncertainty.data);
  EXPECT_EQ(a.normal_sigma.data, b.normal_sigma.data);
  EXPECT_EQ(a.indirect.data, b.indirect.data);
  EXPECT_EQ(a.indirect_bounces, b.indirect_bounces);
  ASSERT_EQ(has_normals(a), has_normals(b));
  if (has_normals(a)) {
    expect_equal(a.before_normals->materials, b.before_normals->materials);
    EXPECT_EQ(a.before_normals->material, b.before_normals->material);
    EXPECT_EQ(a.before_normals->weights.data, b.before_normals->weights.data);
    EXPECT_EQ(a.before_normals->projection_weights.data, b.before_normals->projection_weights.data);
  }
  EXPECT_EQ(a.samples.data, b.samples.data);
  EXPECT_EQ(a.mesh.positions, b.mesh.positions);
  EXPECT_EQ(a.mesh.triangles, b.mesh.triangles);
  EXPECT_EQ(Json::parse(a.provenance_json), Json::parse(b.provenance_json));
}

TEST(ModelFile, EverythingComesBackToTheLastBit) {
  const TemporaryFolder folder;
  const Model written = odd_model();
  write_model(folder / "model", written);
  expect_equal(read_model(folder / "model"), written);
}

TEST(ModelFile, FittedNormalsAndTheStagesBeforeThemComeBackToo) {
  const TemporaryFolder folder;
  const Model written = model_on_fitted_normals();
  write_model(folder / "model", written);
  expect_equal(read_model(folder / "model"), written);
}

TEST(ModelFile, OneChannelComesBackToo) {
  const TemporaryFolder folder;
  Model written = model_of(square_mesh(), 2, 2, diffuse_brdf(0.25, 0, 0));
  written.channels = written.single.channels = 1;
  written.materials[0].brdf.channels = written.materials[0].basis[0].channels = 1;
  write_model(folder / "model", written);
  expect_equal(read_model(folder / "model"), written);
}

TEST(ModelFile, AModelIsReplacedAsAWholeAndNothingElseIs) {
  const TemporaryFolder folder;
  write_model(folder / "model", odd_model());
  const Model second = model_of(square_mesh(), 2, 2, diffuse_brdf(0.25, 0.5, 0.75));
  write_model((folder / "model").string() + "/", second);
  expect_equal(read_model(folder / "model"), second);
  EXPECT_FALSE(fs::exists(folder / "model" / "weights_1.exr")) << "left over from the first";
  EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 1) << "left over beside the model";

  fs::create_directory(folder / "letters");
  write_whole_file(folder / "letters" / "love.txt", "dear");
  EXPECT_BAD_INPUT(write_model(folder / "letters", second), "letters", "not a model");
  EXPECT_TRUE(fs::exists(folder / "letters" / "love.txt"));
}

TEST(ModelFile, AFileChangedSinceIsNamed) {
  const TemporaryFolder folder;
  write_model(folder / "model", odd_model());
  write_whole_file(folder / "model" / "report.html", "beside it");
  EXPECT_TRUE(changed_files(folder / "model").empty());
  const fs::path weights = folder / "model" / "weights_0.exr", other = folder / "model" / "weights_1.exr";
  const std::string bytes = read_whole_file(weights);
  fs::rename(other, weights);  // another whole map in its place
  write_whole_file(other, bytes);
  EXPECT_EQ(changed_files(folder / "model"), (std::vector<std::string>{"weights_0.exr", "weights_1.exr"}));
}

// Models of before there were hashes are read as ever.
TEST(ModelFile, WithoutHashesNothingIsCalledChanged) {
  const TemporaryFolder folder;
  write_model(folder / "model", odd_model());
  Json description = Json::parse(read_whole_file(folder / "model" / "model.json"));
  EXPECT_EQ(description.at("sha256").size(), 1u + description.at("maps").size() + 2u) << "basis, maps, mesh and outliers";
  description.erase("sha256");
  write_whole_file(folder / "model" / "model.json", description.dump());
  write_whole_file(folder / "model" / "mesh.ply", "other");
  EXPECT_TRUE(changed_files(folder / "model").empty());
}

TEST(ModelFile, AModelWhoseMapsDoNotFitIsNotWritten) {
  const TemporaryFolder folder;
  Model model = odd_model();
  model.normal = Image(5, 5, 3);
  EXPECT_THROW(write_model(folder / "model", model), Error);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

// A written model of which one file is then damaged.
class DamagedModel : public testing::Test {
 protected:
  DamagedModel() { write_model(model_, odd_model()); }
  fs::path file(const std::string& name) const { return model_ / name; }

  void edit_json(const std::string& name, const std::string& pointer, const Json& value) {
    Json document = Json::parse(read_whole_file(file(name)));
    document[Json::json_pointer(pointer)] = value;
    write_whole_file(file(name), document.dump());
  }
  void erase_key(const std::string& name, const std::string& parent, const std::string& key) {
    Json document = Json::parse(read_whole_file(file(name)));
    document[Json::json_pointer(parent)].erase(key);
    write_whole_file(file(name), document.dump());
  }
  void edit_plane(const std::string& name, const std::string& plane, std::size_t texel, float value) {
    ExrImage exr = read_exr(file(name));
    for (ExrPlane& candidate : exr.planes) {
      if (candidate.name == plane) candidate.data[texel] = value;
    }
    write_exr(file(name), exr);
  }

  const TemporaryFolder folder_;
  const fs::path model_ = folder_ / "model";
};

TEST_F(DamagedModel, EveryMissingFileIsNamed) {
  EXPECT_BAD_INPUT(read_model(folder_ / "nowhere"), "nowhere");
  for (const std::string name : {"model.json", "basis.json", "cluster.exr", "weights_0.exr", "weights_1.exr",
                                 "normal.exr", "uncertainty.exr", "samples.exr", "mesh.ply"}) {
    fs::rename(file(name), file("hidden"));
    EXPECT_BAD_INPUT(read_model(model_), name);
    fs::rename(file("hidden"), file(name));
  }
}

TEST_F(DamagedModel, EveryTruncatedFileIsNamed) {
  for (const std::string name :
       {"model.json", "basis.json", "cluster.exr", "weights_1.exr", "normal.exr", "mesh.ply"}) {
    const std::string bytes = read_whole_file(file(name));
    write_whole_file(file(name), bytes.substr(0, bytes.size() / 2));
    EXPECT_BAD_INPUT(read_model(model_), name);
    write_whole_file(file(name), bytes);
  }
}

struct JsonDamage {
  std::string file, pointer;
  Json value;
  std::vector<std::string> named;
};

TEST_F(DamagedModel, EveryWrongFieldIsNamed) {
  const std::string lobe = "/materials/0/basis/3/lobes/0/1/";
  const std::string lobe_name = "basis.json.materials[0].basis[3].lobes[0][1].";
  const std::vector<JsonDamage> damages{
      {"model.json", "/format", "something else", {"model.json", "format"}},
      {"model.json", "/version", 2, {"model.json", "version", "2"}},
      {"model.json", "/channels", {"R", "G"}, {"model.json", "channels"}},
      {"model.json", "/atlas/width", 7, {"cluster.exr", "6x5", "7x5"}},
      {"model.json", "/atlas/height", -1, {"model.json", "atlas", "height", "-1"}},
      {"model.json", "/materials", 3, {"basis.json", "materials", "3"}},
      {"model.json", "/basis_size", 6, {"basis.json", "6"}},
      {"model.json", "/provenance", "lost", {"model.json", "provenance"}},
      {"model.json", "/provenance/rms", 0.1, {"model.json", "provenance.rms"}},
      {"basis.json", "/single/diffuse/1", -0.5, {"basis.json.single.diffuse[1]", "-0.5"}},
      {"basis.json", "/single/diffuse/2", nullptr, {"basis.json.single.diffuse[2]"}},
      {"basis.json", "/single/diffuse", {0.1, 0.2}, {"basis.json.single.diffuse", "2 entries"}},
      {"basis.json", lobe + "log_exponent", 12.0, {lobe_name + "log_exponent"}},
      {"basis.json", lobe + "phi_rad", "north", {lobe_name + "phi_rad", "north"}},
      {"basis.json", lobe + "exponent", 1e6, {lobe_name + "exponent", "logarithm"}},
      {"basis.json", lobe + "peak", 0.5, {lobe_name + "peak", "logarithm"}},
      {"basis.json", lobe + "log_peak", "loud", {lobe_name + "log_peak"}},
      {"basis.json", "/materials/0/error/relative", -0.1, {"basis.json.materials[0].error.relative", "-0.1"}},
      {"basis.json", "/materials/0/error/freedom", 0, {"basis.json.materials[0].error.freedom"}},
      {"basis.json", "/materials/0/error/outlier_scale", 0.5, {"basis.json.materials[0].error.outlier_scale"}},
      {"basis.json", "/materials/0/error/correlation/2", {1.0}, {"basis.json.materials[0].error.correlation[2]", "1 entries"}},
      {"basis.json", "/materials/0/error/correlation/0/0", -0.1, {"basis.json.materials[0].error.correlation", "positive definite"}}};
  for (const JsonDamage& damage : damages) {
    const std::string intact = read_whole_file(file(damage.file));
    edit_json(damage.file, damage.pointer, damage.value);
    for (const std::string& part : damage.named) EXPECT_BAD_INPUT(read_model(model_), part) << damage.pointer;
    write_whole_file(file(damage.file), intact);
  }
}

TEST_F(DamagedModel, MissingKeysAreNamed) {
  for (const std::string key : {"diffuse", "lobes"}) {
    const std::string intact = read_whole_file(file("basis.json"));
    erase_key("basis.json", "/materials/1/brdf", key);
    EXPECT_BAD_INPUT(read_model(model_), "basis.json.materials[1].brdf", key);
    write_whole_file(file("basis.json"), intact);
  }
  const std::string intact = read_whole_file(file("basis.json"));
  erase_key("basis.json", "/materials/0/error", "floor");
  EXPECT_BAD_INPUT(read_model(model_), "basis.json.materials[0].error", "floor");
  write_whole_file(file("basis.json"), intact);
  erase_key("basis.json", "/materials/0", "error");  // as in models of before it was kept
  EXPECT_FALSE(read_model(model_).materials[0].error);
  erase_key("model.json", "/atlas", "width");
  EXPECT_BAD_INPUT(read_model(model_), "model.json", "atlas", "width");
}

struct MapDamage {
  std::string file, plane;
  float value;
};

TEST_F(DamagedModel, EveryImpossibleTexelIsNamed) {
  constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
  const std::vector<MapDamage> damages{{"cluster.exr", "Y", 2.0f},      {"weights_0.exr", "B", kNan},
                                       {"weights_1.exr", "R", -0.001f}, {"normal.exr", "G", 1.5f},
                                       {"normal.exr", "R", kNan},       {"uncertainty.exr", "Y", kNan},
                                       {"samples.exr", "Y", -1.0f}};
  for (const MapDamage& damage : damages) {
    const std::string intact = read_whole_file(file(damage.file));
    edit_plane(damage.file, damage.plane, 6 * 3 + 4, damage.value);
    EXPECT_BAD_INPUT(read_model(model_), damage.file, "(4, 3)");
    write_whole_file(file(damage.file), intact);
  }
}

TEST_F(DamagedModel, AMeshWithoutTextureCoordinatesIsNamed) {
  Mesh mesh = read_mesh(file("mesh.ply"));
  mesh.texcoords.clear();
  write_ply(file("mesh.ply"), mesh);
  EXPECT_BAD_INPUT(read_model(model_), "mesh.ply", "texture coordinates");
}

}  // namespace
}  // namespace lumitexel
