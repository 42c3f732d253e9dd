#include "processing/fit/fit_model.h"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/sphere_session.h"

namespace lumitexel {
namespace {

FittedModel fit_sphere(int materials, const TemporaryFolder& folder) {
  const CalibratedSession session = sphere_session(
      {view_of_origin("a", {0.5, 0, 0}, {0.6, 0.4, 0.3}), view_of_origin("b", {0.45, 0.2, 0.1}, {0.6, -0.4, 0.3}),
       view_of_origin("c", {0.45, -0.2, 0.1}, {0.7, 0.1, -0.3}), view_of_origin("d", {0.4, 0.1, 0.3}, {0.7, 0.1, 0.5})},
      folder);
  FitOptions options = FitOptions::preset("standard");
  options.materials = materials;
  NoProgress progress;
  return fit_model(session, options, {}, progress);
}

TEST(FitModel, AMatteSphereHasOneDiffuseMaterialOfItsAlbedo) {
  const TemporaryFolder folder;
  const FittedModel fitted = fit_sphere(1, folder);
  ASSERT_EQ(fitted.model.materials.size(), 1u);
  // Half a percent: bilinear sampling of curved shading; there is no noise.
  EXPECT_NEAR(fitted.model.materials[0].brdf.diffuse[0], kSphereAlbedo / M_PI, 0.005 * kSphereAlbedo / M_PI);
  EXPECT_LT(fitted.summary.projection.rms, 0.005);
  // 45 degrees on one side, where no lobe reaches.
  const LobeGeometry geometry{1.0, std::sqrt(0.5), std::sqrt(0.5)};
  for (std::size_t texel = 0; texel < fitted.model.material.size(); ++texel) {
    if (fitted.model.samples.data[texel] < 1.0f) continue;
    const int x = static_cast<int>(texel) % fitted.model.width, y = static_cast<int>(texel) / fitted.model.width;
    ASSERT_NEAR(evaluate_texel(fitted.model, FitStage::Projection, x, y, 0, geometry), kSphereAlbedo / M_PI, 0.02);
  }
}

// The sphere in millimetres: its cameras stand inside it.
TEST(FitModel, AMeshThatNoPhotographSeesIsToldBySizeAndDistance) {
  const TemporaryFolder folder;
  CalibratedSession session = sphere_session({view_of_origin("a", {0.5, 0, 0}, {0.6, 0.4, 0.3}), view_of_origin("b", {0, 0.25, 0}, {0.6, 0.4, 0.3}),
                                              view_of_origin("out", {0, 9, 0}, {0.6, 0.4, 0.3})},
                                             folder);
  session.views.back().heldout = true;
  for (Eigen::Vector3d& position : session.mesh.positions) position *= 1000.0;
  NoProgress progress;
  const auto fit = [&] { fit_model(session, FitOptions::preset("draft"), {}, progress); };
  EXPECT_BAD_INPUT(fit(), "200 x 200 x 200 m about (0, 0, 0)", "0.25 to 0.5 m", "2 of 2 have its middle", "millimetres", "frame of the poses");
  session.views[0].camera_from_world.prerotate(Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitX()));  // looks away
  EXPECT_BAD_INPUT(fit(), "1 of 2 have its middle");
  for (View& view : session.views) view.heldout = true;
  EXPECT_BAD_INPUT(fit(), "session", "all are held out");
}

TEST(FitModel, ProvenanceSaysWhatWasDone) {
  const TemporaryFolder folder;
  const FittedModel fitted = fit_sphere(2, folder);
  const auto provenance = nlohmann::json::parse(fitted.model.provenance_json);
  EXPECT_EQ(provenance.at("lumitexels"), fitted.summary.lumitexels);
  EXPECT_EQ(provenance.at("samples"), fitted.summary.samples);
  EXPECT_EQ(provenance.at("options").at("quality"), "standard");
  std::vector<std::string> names;
  for (const auto& stage : provenance.at("stages")) {
    names.push_back(stage.at("name"));
    EXPECT_GT(stage.at("peak_bytes").get<double>(), 0.0);
  }
  // A sphere asks for neither: both were looked for, and nothing was fitted again.
  EXPECT_EQ(names, (std::vector<std::string>{"atlas", "lumitexels", "materials", "projection", "light between surfaces", "are normals worth it",
                                             "model"}));
  EXPECT_EQ(provenance.at("normals"), "mesh");
  EXPECT_EQ(provenance.at("light_between_surfaces").at("samples_followed"), 0);
  EXPECT_FALSE(has_normals(fitted.model));
  EXPECT_EQ(fitted.model.indirect_bounces, 0);
}

// The paper's method ends with functions moved to fit; what the texels mixed before stays in the model and can be shown.
TEST(FitModel, WithPrincipalFunctionsBothStagesAreKept) {
  const TemporaryFolder folder;
  const CalibratedSession session = sphere_session(
      {view_of_origin("a", {0.5, 0, 0}, {0.6, 0.4, 0.3}), view_of_origin("b", {0.45, 0.2, 0.1}, {0.6, -0.4, 0.3}),
       view_of_origin("c", {0.45, -0.2, 0.1}, {0.7, 0.1, -0.3}), view_of_origin("d", {0.4, 0.1, 0.3}, {0.7, 0.1, 0.5})},
      folder);
  FitOptions options = as_published(FitOptions::preset("draft"));
  options.materials = 2;
  NoProgress progress;
  const FittedModel fitted = fit_model(session, options, {}, progress);
  ASSERT_TRUE(fitted.summary.pfa.has_value());
  EXPECT_LE(fitted.summary.pfa->rms, fitted.summary.projection.rms * (1.0 + 1e-6));  // least squares of the same samples, moved on
  EXPECT_TRUE(has_principal_functions(fitted.model));
  const auto rms = nlohmann::json::parse(fitted.model.provenance_json).at("rms");
  EXPECT_EQ(rms.at("pfa"), fitted.summary.pfa->rms);
  EXPECT_EQ(rms.at("projection"), fitted.summary.projection.rms);
}

TEST(FitModel, EveryTexelThatATriangleCanShowHasAMaterial) {
  const TemporaryFolder folder;
  const FittedModel fitted = fit_sphere(1, folder);
  const Model& model = fitted.model;
  for (const auto& triangle : model.mesh.triangles) {
    Eigen::Vector2d uv = Eigen::Vector2d::Zero();
    for (const std::uint32_t vertex : triangle) uv += model.mesh.texcoords[vertex] / 3.0;
    const int x = static_cast<int>(uv.x() * model.width), y = static_cast<int>((1.0 - uv.y()) * model.height);
    EXPECT_NE(model.material[static_cast<std::size_t>(y) * static_cast<std::size_t>(model.width) + static_cast<std::size_t>(x)],
              Model::kNoMaterial);
  }
}

TEST(FitPresets, GoFromQuickToThoroughAndThePapersMethodTakesNothingFromThem) {
  const FitOptions draft = FitOptions::preset("draft"), standard = FitOptions::preset("standard"), reference = FitOptions::preset("reference");
  EXPECT_EQ(standard.most_lobes, 2);
  EXPECT_EQ(standard.materials, 0);
  EXPECT_EQ(draft.interreflections.choice, InterreflectionChoice::Off);
  EXPECT_EQ(draft.normals, NormalChoice::Mesh);
  EXPECT_EQ(draft.errors, ErrorSource::Auto);  // given ones are less exact with few photographs
  EXPECT_EQ(standard.normals, NormalChoice::Auto);
  EXPECT_EQ(standard.interreflections.choice, InterreflectionChoice::Auto);
  EXPECT_GT(reference.interreflections.rounds, standard.interreflections.rounds);
  EXPECT_GT(reference.learning_lumitexels, standard.learning_lumitexels);
  EXPECT_FALSE(reference.family.has_value());
  for (const FitOptions& preset : {draft, standard, reference}) {
    const FitOptions paper = as_published(preset);
    EXPECT_EQ(paper.family, BrdfFamily::Lafortune);
    EXPECT_EQ(paper.most_lobes, 1);
    EXPECT_EQ(paper.materials, kMaterialsOfThePaper);
    EXPECT_EQ(paper.lobe_shapes, LobeShapes::Separate);
    EXPECT_EQ(paper.normals, NormalChoice::Mesh);
    EXPECT_EQ(paper.interreflections.choice, InterreflectionChoice::Off);
  }
  EXPECT_BAD_INPUT(FitOptions::preset("best"), "--quality", "best");
}

}  // namespace
}  // namespace lumitexel
