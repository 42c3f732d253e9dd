#include "processing/report/model_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>
#include <set>

#include "processing/image/tone_map.h"
#include "processing/report/html.h"
#include "processing/report/view_pictures.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

using testing::HasSubstr;
using testing::Not;

class ModelReport : public testing::Test {
 protected:
  ModelReport() : model_(model_of(sphere_mesh(24, 12), 4, 4, diffuse_brdf(0.125, 0.2, 0.3))) {
    model_.provenance_json = R"({"session_key": "bench", "samples": 123456, "rms": {"single": 0.0987, "cluster": 0.0531,
      "projection": 0.0246}, "rms_by_channel": {"single": [0.0911, 0.0922, 0.0933]},
      "rms_by_material": {"cluster": [0.0531], "projection": [0.0246]},
      "stages": [{"name": "cluster </script><b>", "seconds": 12.5, "peak_bytes": 104857600}]})";
    session_.key = "bench";
    session_.mesh = model_.mesh;
    View view = view_from_above(32, 3.0);
    view.name = "evening & <view>";
    view.heldout = true;
    view.photograph = folder_ / "photograph.exr";
    RadianceImage photograph{Image(32, 32, 3, 0.1f), Image(32, 32, 3), std::vector<std::uint8_t>(32 * 32, 0)};
    write_radiance_image(view.photograph, photograph);
    session_.views.push_back(view);
    calibration_.poses = {{view.name, "silhouette", 0.00012, 0.034, 0.57, 4, "silhouette"}};
    calibration_.lights = {{.view = view.name, .sigma_m = 0.00081, .from_spheres = true, .highlights = 5}};
    calibration_.intensity = {1.0, 2.0, 3.0};
    exposures_ = {{view.name, true, {0.003, 0.024, 0.192}, 0.0123, 0.456, {0.01, 0.02, 0.04, 0.08, 0.16}}};
  }

  std::string page(bool with_session) {
    NoProgress progress;
    ReportSubject subject{"bird", model_};
    if (with_session) {
      evaluation_ = evaluate_model(model_, session_, progress);
      subject.session = &session_;
      subject.evaluation = &evaluation_;
      subject.calibration = &calibration_;
      subject.exposures = exposures_;
    }
    return model_report(subject, report_json(subject), progress);
  }

  const TemporaryFolder folder_;
  Model model_;
  CalibratedSession session_;
  Evaluation evaluation_;
  CalibrationSummary calibration_;
  std::vector<PhotographExposure> exposures_;
};

TEST_F(ModelReport, NeedsNothingButItself) {
  const std::string html = page(true);
  for (const char* outside : {"http", "<link", "@import", "url(", "href=", "//cdn"})
    EXPECT_THAT(html, Not(HasSubstr(outside)));
  std::size_t pictures = 0;
  for (std::size_t at = html.find("src="); at != std::string::npos; at = html.find("src=", at + 1), ++pictures) {
    EXPECT_EQ(html.substr(at, 33), "src=\"data:image/png;base64,iVBORw") << "a PNG's first bytes";
  }
  EXPECT_EQ(pictures, 10u) << "photograph and rendering on top; photograph, rendering, difference, map, sphere, coverage, uncertainty, its causes";
}

TEST_F(ModelReport, SaysTheNumbersOfTheFitAndOfTheComparison) {
  const std::string html = page(true);
  for (const char* text : {"0.0987", "0.0531", "0.0246", "0.0911", "0.249", "123456", "12.5 s", "100 MiB"}) {
    EXPECT_THAT(html, HasSubstr(text));
  }
  EXPECT_THAT(html, HasSubstr(html::number(evaluation_.heldout[2]->relative_rms)));
  EXPECT_THAT(html, HasSubstr(html::number(evaluation_.heldout[0]->psnr_db)));
}

TEST_F(ModelReport, CautionsWhereAnEarlierStagePredictsBetter) {
  EXPECT_THAT(page(true), Not(HasSubstr("Caution")));
  model_.single = diffuse_brdf(0.1, 0.1, 0.1);  // as the photograph is, which was kept out
  EXPECT_THAT(page(true), Not(HasSubstr("Caution"))) << "one photograph says nothing for sure";
  for (int more = 0; more < 2; ++more) {
    session_.views.push_back(session_.views[0]);
    exposures_.push_back(exposures_[0]);
    calibration_.poses.push_back(calibration_.poses[0]);
    calibration_.lights.push_back(calibration_.lights[0]);
  }
  const std::string html = page(true);
  EXPECT_THAT(html, HasSubstr("Caution: photographs kept out of the fit were predicted better before its last stage"));
  EXPECT_THAT(html, HasSubstr("at stage single"));
}

TEST_F(ModelReport, OnePhotographIsSpokenOfAsOne) {
  const std::string html = page(true);
  EXPECT_THAT(html, HasSubstr("One photograph was kept out of the measurement as a test, and the model predicts it"));
  EXPECT_THAT(html, Not(HasSubstr("neither the best nor the worst")));
}

TEST_F(ModelReport, NamesFromFilesCannotBecomeMarkup) {
  const std::string html = page(true);
  EXPECT_THAT(html, HasSubstr("evening &amp; &lt;view&gt;"));
  EXPECT_THAT(html, HasSubstr("cluster &lt;/script&gt;&lt;b&gt;"));
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t start = html.find(open) + open.size();
  const auto data = nlohmann::json::parse(html.substr(start, html.find("</script>") - start));
  EXPECT_EQ(data.at("provenance").at("stages")[0].at("name"), "cluster </script><b>");
  EXPECT_EQ(data.at("evaluation"), nlohmann::json::parse(evaluation_json(evaluation_)));
  EXPECT_EQ(data.at("texels_by_material"), nlohmann::json::array({16}));
}

TEST_F(ModelReport, SaysWhatLeftOutSamplesDecided) {
  EXPECT_THAT(page(false), Not(HasSubstr("What the samples decided")));
  auto provenance = nlohmann::json::parse(model_.provenance_json);
  provenance["choices"] = {{{"of", "functions mixed by a texel of material 3"}, {"candidate", "7"}, {"over", "3"}, {"gain", 0.0123}, {"gain_sigma", 0.0045}, {"taken", true}},
                          {{"of", "errors"}, {"candidate", "estimated"}, {"over", "labels"}, {"gain", nullptr}, {"gain_sigma", nullptr}, {"taken", false}}};
  provenance["normals_worth"] = {{"deviance_gain", 0.237}, {"deviance_gain_sigma", 0.0677}, {"left_out_samples", 51008}};
  provenance["normals"] = "fitted";
  model_.provenance_json = provenance.dump();
  const std::string html = page(false);
  EXPECT_THAT(html, HasSubstr("What the samples decided"));
  EXPECT_THAT(html, HasSubstr("functions mixed by a texel of material 3"));
  EXPECT_THAT(html, HasSubstr("<td>3</td><td>7</td>"));
  EXPECT_THAT(html, HasSubstr("1.2 %"));
  EXPECT_THAT(html, HasSubstr("± 0.45 %"));
  EXPECT_THAT(html, HasSubstr("<td>not taken</td>"));
  EXPECT_THAT(html, HasSubstr("0.237 ± 0.0677"));
}

TEST_F(ModelReport, CoverageCountsOnlyTexelsThatWereMeasured) {
  model_.samples.data = {0, 0, 0, 0, 0, 0, 2, 2, 4, 4, 4, 4, 4, 4, 4, 9};  // six texels borrow
  model_.uncertainty.data.assign(16, 1.0f);
  for (std::size_t i = 6; i < 16; ++i) model_.uncertainty.data[i] = 0.125f;
  const auto coverage = nlohmann::json::parse(report_json({"bird", model_})).at("coverage");
  EXPECT_EQ(coverage.at("texels"), 16);
  EXPECT_EQ(coverage.at("texels_measured"), 10);
  EXPECT_EQ(coverage.at("samples_a_texel").at("tenth"), 2.0);
  EXPECT_EQ(coverage.at("samples_a_texel").at("median"), 4.0);
  EXPECT_EQ(coverage.at("samples_a_texel").at("most"), 9.0);
  EXPECT_EQ(coverage.at("relative_sigma").at("nine_tenths"), 0.125);
  EXPECT_THAT(page(false), HasSubstr("nine tenths within 12"));
}

TEST_F(ModelReport, NamesTheNearestKnownMaterialAndSaysHowNearItIs) {
  const Brdf own = model_.materials[0].brdf;
  const auto scaled = [own](double factor) {
    return [own, factor](const LobeGeometry& g) { ChannelValues f = evaluate(own, g); for (double& v : f) v *= factor; return f; };
  };
  const std::vector<KnownMaterial> known{{"chalk <white>", scaled(8.0)}, {"same", scaled(1.0)}};
  NoProgress progress;
  ReportSubject subject{"bird", model_};
  subject.known = known;
  subject.known_source = "the blackboard & chalk database";
  const std::string html = model_report(subject, report_json(subject), progress);
  EXPECT_THAT(html, HasSubstr("hardly to be told apart"));
  EXPECT_THAT(html, HasSubstr("same (0)"));
  EXPECT_THAT(html, HasSubstr("beside the 2 of the blackboard &amp; chalk database"));
  EXPECT_THAT(html, HasSubstr("chalk &lt;white&gt; ("));
  const auto nearest = nlohmann::json::parse(report_json(subject)).at("nearest_materials");
  EXPECT_EQ(nearest[0][0].at("name"), "same");
  EXPECT_EQ(nearest[0][0].at("distance"), 0.0);
}

TEST_F(ModelReport, SaysHowFarNormalsWereTurnedAndHowSurely) {
  EXPECT_THAT(page(false), Not(HasSubstr("raking light"))) << "no fitted normals, nothing to show";
  EXPECT_TRUE(nlohmann::json::parse(report_json({"bird", model_})).at("normals").is_null());

  model_ = model_of(square_mesh(), 4, 4, diffuse_brdf(0.125, 0.2, 0.3));
  model_.before_normals = ReflectanceLayer{model_.materials, model_.material, model_.weights, {}};
  model_.samples.data[0] = 0.0f;  // not measured: takes no part
  model_.normal_sigma = Image(4, 4, 1, 0.05f);
  const double tilt_rad = 0.2;
  for (std::size_t texel = 0; texel < 16; ++texel) {  // the mesh's own in the first six, turned in the others
    const double angle = texel < 6 ? 0.0 : tilt_rad;
    model_.normal.data[3 * texel] = static_cast<float>(std::sin(angle));
    model_.normal.data[3 * texel + 2] = static_cast<float>(std::cos(angle));
  }
  const auto normals = nlohmann::json::parse(report_json({"bird", model_})).at("normals");
  constexpr double kFloat_deg = 1e-4;  // normals are kept in single precision
  EXPECT_EQ(normals.at("texels_measured"), 15);
  EXPECT_EQ(normals.at("texels_on_the_meshs_normal"), 5);
  EXPECT_NEAR(normals.at("tilt_against_mesh_deg").at("median"), tilt_rad * 180.0 / std::numbers::pi, kFloat_deg);
  EXPECT_NEAR(normals.at("sigma_deg").at("nine_tenths"), 0.05 * 180.0 / std::numbers::pi, kFloat_deg);
  const std::string html = page(false);
  EXPECT_THAT(html, HasSubstr("raking light"));
  EXPECT_THAT(html, HasSubstr("Of 15 measured texels, 5 kept"));
  EXPECT_THAT(html, HasSubstr("20° and more"));
}

TEST_F(ModelReport, ShowsLightBetweenSurfacesWhereSomebodyLooked) {
  EXPECT_THAT(page(false), Not(HasSubstr("Light between surfaces")));
  EXPECT_TRUE(nlohmann::json::parse(report_json({"bird", model_})).at("light_between_surfaces").is_null());

  model_.indirect = Image(4, 4, 2);
  model_.samples.data[0] = 0.0f;  // not measured: takes no part
  for (std::size_t texel = 0; texel < 16; ++texel) {
    model_.indirect.data[2 * texel] = texel < 8 ? 0.125f : 0.25f;
    model_.indirect.data[2 * texel + 1] = texel == 0 ? 1.0f : 0.0625f;
  }
  EXPECT_THAT(page(false), HasSubstr("nothing was taken out"));
  EXPECT_THAT(page(false), Not(HasSubstr(", as found")));

  model_.indirect_bounces = 2;
  const auto data = nlohmann::json::parse(report_json({"bird", model_})).at("light_between_surfaces");
  EXPECT_EQ(data.at("bounces"), 2);
  EXPECT_EQ(data.at("estimated_most").at("median"), 0.125 + 0.125) << "seven texels of the lower value, eight of the higher one";
  EXPECT_EQ(data.at("found_share").at("most"), 0.0625);
  const std::string html = page(false);
  EXPECT_THAT(html, HasSubstr("2 bounces"));
  EXPECT_THAT(html, HasSubstr("light between surfaces, as found"));
  EXPECT_THAT(html, HasSubstr("nine tenths at most 6.2 %"));
}

// Every cell of every table that is one number, with or without a unit. The first column names the rows.
std::vector<std::string> numbers_in_tables(const std::string& html) {
  std::vector<std::string> numbers;
  static const std::regex kRow("<tr>((?:<td>[^<]*</td>)+)</tr>"), kCell("<td>([^<]*)</td>"),
      kNumber("^(-?[0-9.]+(?:e[-+][0-9]+)?)(?: ?(?:%|°|dB|s|mm|px|m|stops))?$");
  for (std::sregex_iterator row(html.begin(), html.end(), kRow), end; row != end; ++row) {
    const std::string cells = (*row)[1];
    int column = 0;
    for (std::sregex_iterator cell(cells.begin(), cells.end(), kCell); cell != end; ++cell, ++column) {
      const std::string text = (*cell)[1];
      std::smatch match;
      if (column > 0 && std::regex_match(text, match, kNumber)) numbers.push_back(match[1]);
    }
  }
  return numbers;
}

// As the page may write it: by html::number, plain, as percent, or in thousandths (mm of m).
void collect_numbers(const nlohmann::json& data, std::set<std::string>& written) {
  if (data.is_structured()) {
    for (const auto& item : data) collect_numbers(item, written);
  } else if (data.is_number()) {
    for (const int digits : {2, 3, 4, 8}) {
      for (const double unit : {1.0, 100.0, 1000.0}) written.insert(html::number(unit * data.get<double>(), digits));
    }
  }
}

TEST_F(ModelReport, EveryNumberOfItsTablesIsInItsJson) {
  const std::string html = page(true);
  const std::vector<std::string> numbers = numbers_in_tables(html);
  EXPECT_GE(numbers.size(), 20u);
  std::set<std::string> written;
  const std::string open = "<script type=\"application/json\" id=\"data\">";
  const std::size_t start = html.find(open) + open.size();
  collect_numbers(nlohmann::json::parse(html.substr(start, html.find("</script>") - start)), written);
  for (const std::string& number : numbers) EXPECT_TRUE(written.count(number)) << number;
}

TEST_F(ModelReport, SaysHowItWasPhotographedAndWhatItDoesNotKnow) {
  const std::string bracketed = page(true);
  EXPECT_THAT(bracketed, HasSubstr("<td>3</td><td>0.00300</td><td>0.192</td><td>6</td><td>1.2 %</td><td>46 %</td>"));
  EXPECT_THAT(bracketed, HasSubstr("stops below the brightest"));
  EXPECT_THAT(bracketed, HasSubstr("silhouette, px"));
  EXPECT_THAT(bracketed, HasSubstr("0.810")) << "a lamp's place in mm";

  exposures_[0].exposure_s.clear();  // imported
  calibration_.intensity.clear();
  const std::string imported = page(true);
  EXPECT_THAT(imported, HasSubstr("knows no exposure times"));
  EXPECT_THAT(imported, HasSubstr("<td>–</td><td>–</td><td>–</td><td>–</td><td>1.2 %</td><td>–</td>"));
  EXPECT_THAT(imported, HasSubstr("Poses were given with the session"));
}

TEST(PhotographExposure, CountsTheObjectsPixelsOnly) {
  RadianceImage photograph{Image(10, 1, 1), Image(10, 1, 1), std::vector<std::uint8_t>(10, 0)};
  for (int x = 0; x < 10; ++x) photograph.radiance.at(x, 0) = static_cast<float>(x);
  photograph.flags[8] = kPixelOutside | kPixelSaturated;
  photograph.flags[9] = kPixelOutside;
  photograph.flags[7] = kPixelSaturated;
  photograph.flags[0] = photograph.flags[1] = kPixelDark;
  const PhotographExposure exposure = exposure_of(photograph);
  EXPECT_EQ(exposure.clipped_share, 0.125);
  EXPECT_EQ(exposure.dark_share, 0.25);
  EXPECT_EQ(exposure.radiance[2], 3.0) << "of 0 to 6: clipped ones are no values, dark ones are";
  EXPECT_EQ(exposure_of({Image(1, 1, 1), Image(1, 1, 1), {kPixelOutside}}).clipped_share, 0.0) << "no object, no share of it";
}

TEST_F(ModelReport, WithoutASessionTheModelAloneIsShown) {
  const std::string html = page(false);
  EXPECT_THAT(html, HasSubstr("--session"));
  EXPECT_THAT(html, HasSubstr("0.0246"));
  EXPECT_THAT(html, Not(HasSubstr("<svg")));
}

TEST_F(ModelReport, PicturesShareOneExposureAndTheDifferenceHasASign) {
  const ViewRenderer renderer(model_);
  const ViewPictures pictures = make_view_pictures(renderer, session_.views[0], 3, FitStage::Projection, 100);
  EXPECT_NEAR(pictures.white, 0.1, 1e-7);
  const int middle = pictures.photograph.width / 2;
  EXPECT_EQ(pictures.photograph.at(middle, middle, 0), 1.0f);
  // The sphere's top has radiance kd under a light of irradiance 1: brighter than 0.1 in every channel, clipped.
  EXPECT_EQ(pictures.rendering.at(middle, middle, 0), 1.0f);
  const auto brighter = false_colour(1.0);
  for (int c = 0; c < 3; ++c)
    EXPECT_NEAR(pictures.difference.at(middle, middle, c), brighter[static_cast<std::size_t>(c)], 1e-6);
}

TEST(Html, NumbersKeepTheirSignificantDigits) {
  EXPECT_EQ(html::number(0.012345), "0.0123");
  EXPECT_EQ(html::number(12.345), "12.3");
  EXPECT_EQ(html::number(1234.5), "1234");
  EXPECT_EQ(html::number(3.0), "3");
  EXPECT_EQ(html::number(0.0), "0");
  EXPECT_EQ(html::number(1.5e-7), "1.50e-07");
  EXPECT_EQ(html::number(std::nan("")), "–");
}

TEST(ToneMap, FollowsTheSrgbCurve) {
  EXPECT_NEAR(srgb_encoded(0.5f), 0.735357f, 1e-5f);   // IEC 61966-2-1
  EXPECT_NEAR(srgb_encoded(0.001f), 0.01292f, 1e-7f);  // its linear part
  EXPECT_EQ(srgb_encoded(2.0f), 1.0f);
  EXPECT_EQ(srgb_encoded(-1.0f), 0.0f);
  EXPECT_EQ(srgb_encoded(std::nanf("")), 0.0f);
  Image gray(1, 1, 1, 2.0f);
  EXPECT_NEAR(tone_mapped(gray, 4.0).at(0, 0, 2), 0.735357f, 1e-5f);
}

}  // namespace
}  // namespace lumitexel
