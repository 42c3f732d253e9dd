// What stands on top of the report, for those who read no further.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "processing/report/measured_area.h"
#include "processing/report/model_report.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

Model square_model() { return model_of(square_mesh(), 4, 4, diffuse_brdf(0.1, 0.1, 0.1)); }

TEST(MeasuredArea, IsTheShareOfTheMeshWithSamplesOfItsOwn) {
  Model model = square_model();
  EXPECT_EQ(measured_area_share(model), 1.0);
  for (std::size_t texel = 0; texel < 8; ++texel) model.samples.data[texel] = 0.0f;  // the upper two rows
  // Triangles are asked at 3 x 3 parts each: the edge between the halves runs through parts, so the half is met to within one row of them.
  EXPECT_NEAR(measured_area_share(model), 0.5, 1.0 / 6.0);
  for (float& count : model.samples.data) count = 0.0f;
  EXPECT_EQ(measured_area_share(model), 0.0);
}

TEST(MeasuredArea, CountsAreaOnTheObjectNotInTheAtlas) {
  Model model = square_model();
  // The lower triangle three times as large on the object, all in one texel of the atlas that has no samples.
  model.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {10, 0, 0}, {13, 0, 0}, {10, 1, 0}};
  model.mesh.texcoords = {{0.5, 0.5}, {1, 0.5}, {0.5, 1}, {0.01, 0.99}, {0.02, 0.99}, {0.01, 0.98}};
  model.mesh.normals.assign(6, Eigen::Vector3d::UnitZ());
  model.mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  model.samples.data[0] = 0.0f;
  EXPECT_NEAR(measured_area_share(model), 0.25, 1e-12);
}

class ReportSummary : public testing::Test {
 protected:
  ReportSummary() : model_(square_model()) {
    session_.mesh = model_.mesh;
    // A square of albedo 0.1 pi under a light of irradiance 1 has radiance 0.1.
    for (const auto& [name, heldout, radiance] : {std::tuple{"good", true, 0.1f}, {"middling", true, 0.125f}, {"bad", true, 0.4f}, {"seen", false, 0.1f}}) {
      View view = view_from_above(16, 3.0);
      view.name = name;
      view.heldout = heldout;
      view.photograph = folder_ / (view.name + ".exr");
      write_radiance_image(view.photograph, {Image(16, 16, 3, radiance), Image(16, 16, 3), std::vector<std::uint8_t>(256, 0)});
      session_.views.push_back(view);
    }
  }

  std::string page() {
    NoProgress progress;
    evaluation_ = evaluate_model(model_, session_, progress);
    const ReportSubject subject{"bird", model_, &session_, &evaluation_};
    summary_ = Json::parse(report_json(subject)).at("summary");
    return model_report(subject, report_json(subject), progress);
  }

  const TemporaryFolder folder_;
  Model model_;
  CalibratedSession session_;
  Evaluation evaluation_;
  Json summary_;
};

TEST_F(ReportSummary, ShowsTheHeldoutPhotographOfMedianError) {
  const std::string html = page();
  EXPECT_EQ(summary_.at("prediction").at("shown"), "middling");
  EXPECT_EQ(summary_.at("prediction").at("photographs"), 3);
  EXPECT_THAT(html, HasSubstr("Photograph middling, kept out of the fit"));
  EXPECT_LT(html.find("Photograph middling"), html.find("<section>")) << "on top";
}

TEST_F(ReportSummary, SaysInWordsAndNumbersHowPhotographsArePredicted) {
  session_.views[2].heldout = false;  // the bad one
  const std::string html = page();
  // (sqrt .1 - sqrt .1)^2 + (sqrt .125 - sqrt .1)^2 over .1 + .125
  const double expected = (std::sqrt(0.125) - std::sqrt(0.1)) / std::sqrt(0.225);
  EXPECT_NEAR(summary_.at("prediction").at("square_roots").get<double>(), expected, 1e-5);
  EXPECT_THAT(html, HasSubstr("2 photographs were kept out of the measurement as a test, and the model predicts them closely: the difference is 7.9 %"));
  EXPECT_THAT(html, HasSubstr("One material was found. All of the object"));
}

TEST_F(ReportSummary, AModelWithoutHeldoutPhotographsIsNotPraisedForRepeatingWhatItSaw) {
  for (View& view : session_.views) view.heldout = false;
  const std::string html = page();
  EXPECT_EQ(summary_.at("prediction").at("kept_out_of_the_fit"), false);
  EXPECT_TRUE(summary_.at("prediction").at("clipped").is_number());
  EXPECT_THAT(html, HasSubstr("none was kept out as a test"));
  EXPECT_THAT(html, HasSubstr("clipped relative error on photographs of the fit"));
  EXPECT_THAT(html, Not(HasSubstr("on photographs kept out of the fit")));
}

TEST_F(ReportSummary, NeverClaimsAllOfTheSurfaceWhereSomeIsMissing) {
  model_ = model_of(square_mesh(), 40, 40, diffuse_brdf(0.1, 0.1, 0.1));
  model_.samples.data[20 * 40 + 20] = 0.0f;
  EXPECT_THAT(page(), HasSubstr("Over 99 % of the object"));
}

}  // namespace
}  // namespace lumitexel
