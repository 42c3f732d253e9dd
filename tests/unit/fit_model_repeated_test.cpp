// The same object gives the same model again: to the byte for any number of threads, and the same BRDFs whatever its size.
#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "processing/fit/fit_model.h"
#include "processing/model/model_file.h"
#include "rig/whole_file.h"
#include "tests/unit/sphere_session.h"
#include "tests/unit/synthetic_lumitexels.h"

namespace lumitexel {
namespace {

constexpr double kRadius_m = 0.1;

Brdf upper() { return one_lobe({0.20, 0.06, 0.04}, {0.4, 0.4, 0.4}, kMirrorAim, 12.0); }
Brdf lower() { return one_lobe({0.04, 0.06, 0.20}, {0.9, 0.9, 0.9}, kMirrorAim, 40.0); }

// Ten photographs, as many as it takes for photographs to judge. `size`: how many times larger everything is, the lamp's power too, so that the
// photographs are the same.
std::vector<View> views_of_size(double size) {
  std::vector<View> views;
  for (int i = 0; i < 10; ++i) {
    const double turn = 2.0 * M_PI * i / 10, high = i % 2 == 0 ? 0.15 : -0.2, aside = turn + 0.5 + 0.05 * i;
    const Eigen::Vector3d eye(0.5 * std::cos(turn), 0.5 * std::sin(turn), high), light(0.6 * std::cos(aside), 0.6 * std::sin(aside), 0.2 - high);
    View view = view_of_origin("view_" + std::to_string(i), size * eye, size * light);
    view.camera = {80, 60, 150.0, 150.0, 40.0, 30.0, 0.0, 0.0, 0.0, 0.0};
    for (double& intensity : view.light.intensity) intensity *= size * size;
    views.push_back(view);
  }
  return views;
}

// Red and dull above its equator, blue and shiny below.
CalibratedSession painted_sphere(double size, const TemporaryFolder& folder) {
  const Brdf above = upper(), below = lower();
  return photographed_session(
      sphere_mesh(size * kRadius_m, 40), views_of_size(size),
      [&](const Eigen::Vector3d& x, const LobeGeometry& geometry) { return evaluate(x.z() > 0.0 ? above : below, geometry); }, folder);
}

FitOptions quick(FitOptions options) {
  options.materials = 2;
  options.learning_lumitexels = options.final_lumitexels = 300;
  return options;
}

// model.json, with the hash of every other file, and without what a run took.
nlohmann::json written(const FittedModel& fitted) {
  const TemporaryFolder folder;
  write_model(folder / "model", fitted.model);
  nlohmann::json model = nlohmann::json::parse(read_whole_file(folder / "model" / "model.json"));
  EXPECT_EQ(model.at("provenance").erase("stages"), 1u);
  EXPECT_GE(model.at("sha256").size(), 6u) << "basis, maps and mesh";
  return model;
}

class FitModelRepeated : public testing::TestWithParam<const char*> {
 protected:
  static FitOptions options() {
    const FitOptions standard = FitOptions::preset("standard");
    return quick(std::string(GetParam()) == "paper" ? as_published(standard) : standard);
  }
};

TEST_P(FitModelRepeated, WritesTheSameBytesForAnyNumberOfThreads) {
  const TemporaryFolder folder;
  const CalibratedSession session = painted_sphere(1.0, folder);
  nlohmann::json first;
  for (const std::size_t threads : {1u, 2u, 4u}) {
    const oneapi::tbb::global_control limit(oneapi::tbb::global_control::max_allowed_parallelism, threads);
    NoProgress progress;
    const nlohmann::json model = written(fit_model(session, options(), {}, progress));
    if (first.is_null()) first = model;
    EXPECT_EQ(model, first) << threads << " threads";
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, FitModelRepeated, testing::Values("ours", "paper"), [](const auto& method) { return std::string(method.param); });

// Two rounds: what was before normals is as one round leaves it, and the second starts from the mesh's normals with the first one's materials.
TEST(FitModelNormalRounds, TheSecondHasTheMaterialsOfTheFirst) {
  const TemporaryFolder folder;
  const CalibratedSession session = painted_sphere(1.0, folder);
  FitOptions options = quick(FitOptions::preset("standard"));
  options.normals = NormalChoice::Fitted;
  NoProgress progress;
  const FittedModel once = fit_model(session, options, {}, progress);
  options.normal_rounds = 2;
  const FittedModel twice = fit_model(session, options, {}, progress);
  const auto stages_of_second_round = [](const FittedModel& fitted) {
    return std::count_if(fitted.summary.stages.begin(), fitted.summary.stages.end(), [](const StageCost& stage) { return stage.name.find("round 2") != std::string::npos; });
  };
  EXPECT_EQ(stages_of_second_round(once), 0);
  EXPECT_GE(stages_of_second_round(twice), 2) << "normals, and materials on them";
  ASSERT_TRUE(once.model.before_normals && twice.model.before_normals);
  EXPECT_EQ(once.model.before_normals->weights.data, twice.model.before_normals->weights.data);
  EXPECT_NE(once.model.normal.data, twice.model.normal.data);
  EXPECT_LE(twice.summary.normal->rms, 1.1 * once.summary.normal->rms) << "of the same samples, whose noise it is";
}

void expect_near(const Brdf& brdf, const Brdf& other, double tolerance) {
  ASSERT_EQ(brdf.lobes.size(), other.lobes.size());
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(brdf.diffuse[c], other.diffuse[c], tolerance * other.diffuse[c]);
    for (std::size_t l = 0; l < brdf.lobes.size(); ++l) {
      EXPECT_NEAR(brdf.lobes[l][c].log_strength, other.lobes[l][c].log_strength, tolerance);
      EXPECT_NEAR(brdf.lobes[l][c].log_shape, other.lobes[l][c].log_shape, tolerance);
      EXPECT_NEAR(brdf.lobes[l][c].aim, other.lobes[l][c].aim, tolerance);
    }
  }
}

std::vector<Brdf> brdfs_at_diameter(double diameter_m) {
  const TemporaryFolder folder;
  NoProgress progress;
  const FittedModel fitted =
      fit_model(painted_sphere(diameter_m / (2.0 * kRadius_m), folder), quick(FitOptions::preset("draft")), {}, progress);
  std::vector<Brdf> brdfs;
  for (const ModelMaterial& material : fitted.model.materials) brdfs.push_back(material.brdf);
  return brdfs;
}

TEST(FitModelOfAnySize, GivesTheSameBrdfsAtAMillimetreAMetreAndAHundredMetres) {
  constexpr double kTolerance = 1e-4;
  const std::vector<Brdf> metre = brdfs_at_diameter(1.0);
  ASSERT_EQ(metre.size(), 2u);
  for (const double diameter_m : {0.001, 100.0}) {
    const std::vector<Brdf> other = brdfs_at_diameter(diameter_m);
    ASSERT_EQ(other.size(), 2u) << diameter_m;
    for (std::size_t j = 0; j < 2; ++j) expect_near(other[j], metre[j], kTolerance);
  }
}

}  // namespace
}  // namespace lumitexel
