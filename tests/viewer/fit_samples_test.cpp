// A texel's samples as the page shows them against what the fit itself found of them: its residuals, its outliers, its light between surfaces.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "processing/fit/fit_model.h"
#include "processing/fit/provenance.h"
#include "processing/report/viewer/fit_errors.h"
#include "processing/report/viewer/light_taken.h"
#include "processing/report/viewer/lumitexel_records.h"
#include "processing/surface/best_view.h"
#include "processing/surface/gather_lumitexels.h"
#include "tests/unit/interreflection/bowl_session.h"

namespace lumitexel {
namespace {

using nlohmann::json;

// A bowl, in which a third of the light comes from other surfaces. The fit is told lamps that are a little off, which leaves residuals to estimate
// errors from, and one that is far off, whose samples are outliers.
const CalibratedSession& bowl_session() {
  static const TemporaryFolder folder;
  static const CalibratedSession session = [] {
    CalibratedSession bowl = photographed_bowl(3, folder);
    for (std::size_t v = 0; v < bowl.views.size(); ++v) {
      for (double& intensity : bowl.views[v].light.intensity) intensity *= v == 5 ? 0.6 : v % 2 == 0 ? 1.01 : 0.99;
    }
    return bowl;
  }();
  return session;
}

struct FittedBowl {
  Model model;
  LumitexelRecords records;
  json provenance;

  explicit FittedBowl(FitOptions options) {
    options.materials = 1;
    options.interreflections.choice = InterreflectionChoice::Always;
    options.interreflections.light.paths = 4;  // not the default, which the samples must not be followed by
    NoProgress progress;
    model = fit_model(bowl_session(), options, {}, progress).model;
    records = lumitexel_records(model, bowl_session(), progress);
    provenance = json::parse(model.provenance_json);
  }
};

FitOptions draft(ErrorSource errors, NormalChoice normals) {
  FitOptions options = FitOptions::preset("draft");
  options.errors = errors;
  options.normals = normals;
  return options;
}

const FittedBowl& on_fitted_normals() {
  static const FittedBowl bowl(draft(ErrorSource::Estimated, NormalChoice::Fitted));
  return bowl;
}

const FittedBowl& on_mesh_normals() {
  static const FittedBowl bowl(draft(ErrorSource::Given, NormalChoice::Mesh));
  return bowl;
}

// The model that the fit predicted the light by is still there, as the stages before normals, so that the light is known sample by sample, but for single
// precision, in which a few of the paths go another way.
TEST(LumitexelRecords, HaveTheFitsResidualAlsoWhereLightWasTakenOut) {
  ASSERT_GT(on_fitted_normals().model.indirect_bounces, 0);
  ASSERT_EQ(on_fitted_normals().provenance.at("light_between_surfaces").at("rounds_taken"), 1);
  double squares = 0.0;
  std::size_t values = 0;
  for (const ViewRecords& view : on_fitted_normals().records.by_view) {
    for (std::size_t s = 0; s < view.measured.size(); ++s, ++values) squares += std::pow(static_cast<double>(view.measured[s] - view.predicted[s]), 2);
  }
  const double reported = on_fitted_normals().provenance.at("rms").at("normal").get<double>();
  EXPECT_NEAR(std::sqrt(squares / static_cast<double>(values)), reported, 1e-3 * reported);
}

// Errors under which what each sample counts is known: shares of the prediction alone, two channels going together.
TEST(LumitexelRecords, SharesAreThoseOfTheLeastSquares) {
  Model model = on_fitted_normals().model;
  ErrorModel error(1.0, 0.0);
  ChannelMatrix correlation = ChannelMatrix::Identity(3, 3);
  correlation(0, 1) = correlation(1, 0) = 0.8;
  error.set_correlation(correlation);
  const double own[] = {1.0 / (1.0 - 0.64), 1.0 / (1.0 - 0.64), 1.0};  // the diagonal of its inverse
  model.materials[0].error = error;
  model.indirect_bounces = 0;  // the paths' scatter would count, too
  const Brdf& brdf = model.materials[0].brdf;
  NoProgress progress;
  const LumitexelRecords records = lumitexel_records(model, bowl_session(), progress);
  std::vector<double> total(records.texel.size(), 0.0), scatter(total), largest(total);
  for (std::size_t k = 0; k < records.by_view.size(); ++k) {
    const View& view = bowl_session().views[records.used_views[k]];
    std::size_t s = 0;
    for (std::size_t i = 0; i < total.size(); ++i) {
      if (records.by_view[k].verdict[i] != 0) continue;
      const float* n = &model.normal.data[std::size_t{3} * records.texel[i]];
      const Eigen::Vector3d normal = Eigen::Vector3d(n[0], n[1], n[2]).normalized(), wo = (view.camera_in_world() - records.position[i]).normalized();
      const ChannelValues predicted = predicted_reflectance(brdf, lobe_geometry(normal, view.light.direction_from(records.position[i]), wo));
      double precision = 0.0;
      for (std::size_t c = 0; c < 3; ++c) precision += own[c] / std::pow(predicted[c], 2);
      const double ratio = static_cast<double>(records.by_view[k].share[s++]) / precision;  // the same for all of a lumitexel's samples
      scatter[i] = total[i] == 0.0 ? 0.0 : std::max(scatter[i], std::abs(ratio / largest[i] - 1.0));
      largest[i] = std::max(largest[i], ratio);
      ++total[i];
    }
  }
  // The photographs' own variance, 1e-6 of their radiance squared, is beside reflectances of 0.2 under irradiances of 0.1 to 1 a hundredth at most.
  for (std::size_t i = 0; i < total.size(); ++i) EXPECT_LT(scatter[i], 0.02) << i;
}

// Of light by the finished model only the whole of a lumitexel is the fit's.
TEST(LightOfFit, IsTheShareThatTheModelKeepsOfEveryLumitexel) {
  const Model& model = on_mesh_normals().model;
  ASSERT_GT(model.indirect_bounces, 0);
  NoProgress progress;
  const RayScene scene(bowl_session().mesh);
  LayoutSummary ignored;
  const Atlas atlas = lay_out(bowl_session(), choose_best_views(bowl_session(), scene), layout_of(model), ignored);
  const LumitexelSet photographed = gather_lumitexels(bowl_session(), atlas, scene, progress).set;
  LumitexelSet set = photographed;
  const std::vector<float> light = take_light_of_fit(model, bowl_session(), set);
  std::size_t at = 0, compared = 0;
  for (std::size_t t = 0; t < set.tiles.size(); ++t) {
    const LumitexelTile &before = photographed.tiles[t], &after = set.tiles[t];
    for (std::size_t i = 0; i < before.size(); ++i) {
      double measured = 0.0, taken = 0.0;
      const std::size_t first = std::size_t{3} * before.first_sample[i];
      for (std::size_t k = first; k < std::size_t{3} * before.first_sample[i + 1]; ++k, ++at) {
        measured += static_cast<double>(before.reflectance[k]);
        taken += static_cast<double>(light[at]);
        EXPECT_EQ(after.reflectance[k], before.reflectance[k] - light[at]);
        const auto added = [&](std::size_t of) { return static_cast<double>(after.variance[of] - before.variance[of]); };
        EXPECT_NEAR(added(k), added(first + (k - first) % 3), 1e-6 * static_cast<double>(after.variance[k])) << "their mean, by channel";
      }
      const auto share = static_cast<double>(model.indirect.data[std::size_t{2} * before.texel[i] + 1]);
      if (share > 0.0) {
        EXPECT_NEAR(taken / measured, share, 1e-5 * share + 1e-7);  // of floats
      }
      compared += share > 0.1;
    }
  }
  EXPECT_GT(compared, 1000u);
}

TEST(ErrorsOfFit, OfModelsBeforeTheyWereKeptAreTheGivenOnesAlone) {
  Model model = on_fitted_normals().model;
  model.materials[0].error.reset();
  EXPECT_FALSE(errors_of_fit(model)) << "these were estimated";
  json provenance = on_fitted_normals().provenance;
  provenance["errors"] = "given";
  model.provenance_json = provenance.dump();
  const auto errors = errors_of_fit(model);
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->weights[0].relative, 0.3);
  EXPECT_EQ(errors->residuals[0].floor, provenance.at("options").at("error_floor").get<double>());
}

}  // namespace
}  // namespace lumitexel
