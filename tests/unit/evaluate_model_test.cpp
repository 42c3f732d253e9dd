#include "processing/evaluation/evaluate_model.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "processing/evaluation/predicted_view.h"
#include "processing/evaluation/stage_caution.h"
#include "processing/image/radiance_image.h"
#include "processing/model/render_view.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

using Json = nlohmann::json;
constexpr double kRounding = 1e-6;
constexpr int kSize = 16;

// A square of radiance 0.5 photographed twice: for the fit as it is, held out under a light twice as bright as is said.
class EvaluateModel : public testing::Test {
 protected:
  EvaluateModel() : model_(model_of(square_mesh(), 2, 2, diffuse_brdf(0.5, 0.5, 0.5))) {
    model_.single = diffuse_brdf(0.25, 0.25, 0.25);
    session_.key = "bench";
    session_.mesh = model_.mesh;
    add_view("fit", false, 0.5f);
    add_view("heldout", true, 1.0f);
  }

  void add_view(const std::string& name, bool heldout, float value) {
    View view = view_from_above(kSize, 5.0);
    view.name = name;
    view.heldout = heldout;
    view.photograph = folder_ / (name + ".exr");
    RadianceImage photograph;
    photograph.radiance = Image(kSize, kSize, 3, value);
    photograph.variance = Image(kSize, kSize, 3);
    photograph.flags.assign(kSize * kSize, 0);
    write_radiance_image(view.photograph, photograph);
    session_.views.push_back(view);
  }
  void edit_photograph(std::size_t view, const std::function<void(RadianceImage&)>& edit) {
    RadianceImage photograph = read_radiance_image(session_.views[view].photograph);
    edit(photograph);
    write_radiance_image(session_.views[view].photograph, photograph);
  }
  Evaluation evaluated() {
    NoProgress progress;
    return evaluate_model(model_, session_, progress);
  }

  const TemporaryFolder folder_;
  Model model_;
  CalibratedSession session_;
};

TEST_F(EvaluateModel, EachSplitAndStageHasItsOwnError) {
  const Evaluation evaluation = evaluated();
  EXPECT_TRUE(evaluation.same_session);
  EXPECT_EQ(evaluation.last_stage, FitStage::Projection);
  EXPECT_NEAR(evaluation.fit[0]->relative_rms, 0.5, kRounding);
  EXPECT_NEAR(evaluation.fit[2]->relative_rms, 0.0, kRounding);
  EXPECT_NEAR(evaluation.heldout[0]->relative_rms, 0.75, kRounding);
  EXPECT_NEAR(evaluation.heldout[1]->relative_rms, 0.5, kRounding);
  EXPECT_NEAR(evaluation.heldout[2]->relative_rms, 0.5, kRounding);
  EXPECT_NEAR(evaluation.heldout[2]->psnr_db, 10.0 * std::log10(4.0), 1e-4);
  EXPECT_EQ(evaluation.views[1].object_pixels, kSize * kSize);
}

TEST_F(EvaluateModel, SaturatedDefectiveAndOutsidePixelsDoNotCountDarkOnesDo) {
  edit_photograph(0, [](RadianceImage& photograph) {
    const std::uint8_t flags[] = {kPixelSaturated, kPixelDefective, kPixelOutside};
    for (int i = 0; i < 3; ++i) {
      photograph.flags[static_cast<std::size_t>(i)] = flags[i];
      photograph.radiance.at(i, 0, 1) = 1e6f;
    }
    photograph.flags[3] = kPixelDark;
  });
  const Evaluation evaluation = evaluated();
  EXPECT_EQ(evaluation.views[0].object_pixels, kSize * kSize - 3);
  EXPECT_NEAR(evaluation.fit[2]->relative_rms, 0.0, kRounding);
}

TEST_F(EvaluateModel, AMaskedPixelThatTheMeshMissesCountsAsBlack) {
  session_.views[0].camera.principal_x_px += 4;  // the left quarter of the picture now misses the square
  Evaluation evaluation = evaluated();
  EXPECT_EQ(evaluation.views[0].object_pixels, kSize * (kSize - 4))
      << "without a mask the mesh says what the object is";
  EXPECT_NEAR(evaluation.fit[2]->relative_rms, 0.0, kRounding);
  edit_photograph(0, [](RadianceImage& photograph) { photograph.flags.back() = kPixelOutside; });
  evaluation = evaluated();
  EXPECT_EQ(evaluation.views[0].object_pixels, kSize * kSize - 1);
  EXPECT_NEAR(evaluation.fit[2]->relative_rms, std::sqrt(4.0 * kSize / (kSize * kSize - 1)), kRounding);
}

TEST_F(EvaluateModel, APhotographOfAnotherSizeIsNamed) {
  session_.views[1].camera.width_px = kSize + 1;
  EXPECT_BAD_INPUT(evaluated(), "heldout.exr", "16x16", "17x16");
}

TEST_F(EvaluateModel, TheMeasuredSurfaceAloneIsJudgedBesideTheWhole) {
  EXPECT_EQ(evaluated().heldout_measured_share, 1.0);
  // Half of the texels borrow, and the photograph is right where the others are.
  for (std::size_t texel : {0u, 2u}) model_.samples.data[texel] = 0.0f;
  edit_photograph(1, [](RadianceImage& photograph) {
    for (int y = 0; y < kSize; ++y) {
      for (int x = kSize / 2; x < kSize; ++x) {
        for (int c = 0; c < 3; ++c) photograph.radiance.at(x, y, c) = 0.5f;
      }
    }
  });
  const Evaluation evaluation = evaluated();
  EXPECT_NEAR(evaluation.heldout_measured_share, 0.5, kRounding);
  EXPECT_NEAR(evaluation.heldout_measured[2]->relative_rms, 0.0, kRounding);
  EXPECT_GT(evaluation.heldout[2]->relative_rms, 0.3);
}

// Errors of single, cluster and projection in each photograph kept out, the same by every measure.
Evaluation kept_out(const std::vector<std::array<double, 3>>& photographs) {
  Evaluation evaluation;
  evaluation.last_stage = FitStage::Projection;
  evaluation.provenance_json = "{}";
  std::array<double, 3> mean{};
  for (const auto& errors : photographs) {
    ErrorByStage& view = evaluation.heldout_views.emplace_back();
    for (std::size_t stage = 0; stage < 3; ++stage) {
      view[stage] = ImageError{errors[stage], errors[stage], errors[stage], 20.0};
      mean[stage] += errors[stage] / static_cast<double>(photographs.size());
    }
  }
  for (std::size_t stage = 0; stage < 3; ++stage) evaluation.heldout[stage] = ImageError{mean[stage], mean[stage], mean[stage], 20.0};
  return evaluation;
}

TEST(StageCaution, IsGivenWhereAnEarlierStageSurelyPredictsBetter) {
  const Evaluation evaluation = kept_out({{0.5, 0.3, 0.40}, {0.5, 0.2, 0.32}, {0.5, 0.4, 0.48}, {0.5, 0.3, 0.40}});
  const auto cautions = stage_cautions(evaluation);
  ASSERT_EQ(cautions.size(), 2u);
  EXPECT_STREQ(cautions[0].measure, "clipped");
  EXPECT_EQ(cautions[0].better, FitStage::Cluster);
  const std::string words = in_words(cautions, evaluation.last_stage);
  EXPECT_NE(words.find("clipped 0.3 at stage cluster, 0.4 at projection; square roots 0.3"), std::string::npos) << words;
  EXPECT_NE(words.find("--bases 1"), std::string::npos) << words;
  EXPECT_EQ(Json::parse(evaluation_json(evaluation)).at("heldout_better_before_last_stage")[0].at("better_stage"), "cluster");
}

TEST(StageCaution, IsNotGivenByChanceNorOfFewPhotographs) {
  EXPECT_TRUE(stage_cautions(kept_out({{0.5, 0.3, 0.2}, {0.5, 0.3, 0.25}, {0.5, 0.3, 0.2}})).empty()) << "better";
  EXPECT_TRUE(stage_cautions(kept_out({{0.5, 0.3, 0.60}, {0.5, 0.3, 0.29}, {0.5, 0.3, 0.30}, {0.5, 0.3, 0.28}})).empty()) << "one photograph alone";
  EXPECT_TRUE(stage_cautions(kept_out({{0.5, 0.3, 0.4}, {0.5, 0.3, 0.4}})).empty()) << "two photographs";
  EXPECT_TRUE(stage_cautions(kept_out({{NAN, NAN, NAN}, {NAN, NAN, NAN}, {NAN, NAN, NAN}})).empty());
  EXPECT_TRUE(stage_cautions({}).empty()) << "nothing kept out";
  EXPECT_EQ(in_words({}, FitStage::Normal), "");
}

TEST_F(EvaluateModel, TheJsonHasEveryKeyThatIsPromised) {
  const Json json = Json::parse(evaluation_json(evaluated()));
  EXPECT_EQ(json.at("rms").at("cluster"), 0.05);
  EXPECT_TRUE(json.at("rms").at("pfa").is_null());
  EXPECT_TRUE(json.at("rms").at("normal").is_null());
  EXPECT_NEAR(json.at("heldout").at("relative_rms").get<double>(), 0.5, kRounding);
  EXPECT_NEAR(json.at("heldout_by_stage").at("single").at("relative_rms").get<double>(), 0.75, kRounding);
  EXPECT_EQ(json.at("heldout_by_stage").at("projection"), json.at("heldout"));
  EXPECT_TRUE(json.at("heldout_by_stage").at("pfa").is_null());
  EXPECT_TRUE(json.at("heldout_by_stage").at("normal").is_null());
  ASSERT_EQ(json.at("views").size(), 2u);
  EXPECT_EQ(json.at("views")[0].at("image"), "fit");
  EXPECT_EQ(json.at("views")[0].at("split"), "fit");
  EXPECT_EQ(json.at("views")[1].at("split"), "heldout");
  for (const char* key : {"relative_rms", "clipped_rms", "sqrt_rms", "psnr_db"}) {
    EXPECT_TRUE(json.at("views")[1].at(key).is_number()) << key;
    EXPECT_TRUE(json.at("fit").contains(key)) << key;
  }
  EXPECT_TRUE(json.contains("rms_by_channel") && json.contains("rms_by_material"));
  EXPECT_EQ(json.at("same_session"), true);
}

TEST_F(EvaluateModel, WithPrincipalFunctionsTheyAreTheLastStage) {
  model_.materials[0].projection_basis = model_.materials[0].basis;
  model_.projection_weights = model_.weights;
  for (float& weight : model_.projection_weights.data) weight *= 2.0f;
  const Json json = Json::parse(evaluation_json(evaluated()));
  EXPECT_EQ(json.at("stage"), "pfa");
  EXPECT_EQ(json.at("heldout_by_stage").at("pfa"), json.at("heldout"));
  EXPECT_NE(json.at("heldout_by_stage").at("projection"), json.at("heldout"));
}

TEST_F(EvaluateModel, AnotherSessionIsAllowedAndSaidAndMissingFiguresAreNull) {
  session_.key = "another";
  session_.views.pop_back();
  const Json json = Json::parse(evaluation_json(evaluated()));
  EXPECT_EQ(json.at("same_session"), false);
  EXPECT_TRUE(json.at("heldout").at("relative_rms").is_null()) << "there is no held-out view";
}

TEST_F(EvaluateModel, AModelWithoutProjectionIsJudgedByItsClusters) {
  model_.materials[0].basis.clear();
  model_.weights = Image(2, 2, 0);
  const Json json = Json::parse(evaluation_json(evaluated()));
  EXPECT_EQ(json.at("stage"), "cluster");
  EXPECT_TRUE(json.at("heldout_by_stage").at("projection").is_null());
  EXPECT_EQ(json.at("heldout_by_stage").at("cluster"), json.at("heldout"));
}

// Two squares at right angles: what one sends to the other is part of the photographs, and of the prediction where the fit took it out.
TEST(PredictedView, AddsLightBetweenSurfacesWhereTheFitTookItOut) {
  Mesh corner = square_mesh();
  Mesh wall = square_mesh();
  for (std::size_t i = 0; i < 4; ++i) {
    const Eigen::Vector3d p = wall.positions[i];
    corner.positions.push_back({1.0, p.y(), 1.0 + p.x()});
    corner.normals.push_back(-Eigen::Vector3d::UnitX());
    corner.texcoords.push_back(wall.texcoords[i]);
  }
  corner.triangles.push_back({4, 5, 6});
  corner.triangles.push_back({4, 6, 7});
  Model model = model_of(corner, 2, 2, diffuse_brdf(0.25, 0.25, 0.25));
  View view = view_from_above(kSize, 5.0);
  view.light.vector_in_world = Eigen::Vector3d(-1, 0, 1).normalized();
  const ViewRenderer renderer(model);
  const Image straight = predicted_view(renderer, view, FitStage::Normal).radiance;
  model.indirect_bounces = 1;
  const Image with = predicted_view(renderer, view, FitStage::Normal).radiance;
  EXPECT_EQ(predicted_view(renderer, view, FitStage::Cluster).radiance.data, with.data);  // without fitted normals all stages were fitted without it
  const int middle = kSize / 2;
  // Beside the wall nearly half of what a point faces is the wall, and far from it little.
  EXPECT_GT(with.at(kSize - 1, middle, 0), 1.2f * straight.at(kSize - 1, middle, 0));
  EXPECT_LT(with.at(0, middle, 0), 1.1f * straight.at(0, middle, 0));

  Model on_fitted = model;
  on_fitted.before_normals = ReflectanceLayer{model.materials, model.material, model.weights, {}};
  const ViewRenderer two_layers(on_fitted);
  EXPECT_EQ(predicted_view(two_layers, view, FitStage::Normal).radiance.data, with.data);
  // The stages before were fitted to samples as photographed.
  EXPECT_EQ(predicted_view(two_layers, view, FitStage::Cluster).radiance.data, straight.data);
}

}  // namespace
}  // namespace lumitexel
