#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "drivers/error.h"
#include "processing/fit/fit_model.h"
#include "processing/model/render_view.h"
#include "processing/report/viewer/listed_outliers.h"
#include "processing/report/viewer/viewer_page.h"
#include "processing/report/viewer/viewer_samples.h"
#include "tests/unit/interreflection/bowl_session.h"
#include "tests/unit/sphere_session.h"
#include "tests/viewer/browser_pictures.h"

namespace lumitexel {
namespace {

using nlohmann::json;

constexpr double kHalfPrecision = 1e-3;  // half floats: relative 5e-4, with room for the single precision before

// A sphere seen from four sides, with a lens that distorts, and what a fit makes of it.
struct FittedSphere {
  TemporaryFolder folder;
  CalibratedSession session;
  Model model;
  LumitexelRecords records;

  FittedSphere() {
    std::vector<View> views = {view_of_origin("a", {0.5, 0, 0}, {0.6, 0.4, 0.3}), view_of_origin("b", {0.45, 0.2, 0.1}, {0.6, -0.4, 0.3}),
                               view_of_origin("c <i>", {0.45, -0.2, 0.1}, {0.7, 0.1, -0.3}), view_of_origin("d", {0.4, 0.1, 0.3}, {0.7, 0.1, 0.5}),
                               view_of_origin("kept out", {0.4, 0.1, 0.2}, {0.7, 0.1, 0.5})};
    for (View& view : views) {
      view.camera.k1 = -0.2;
      view.camera.p1 = 0.01;
    }
    views[1].light = {Light::Type::Directional, Eigen::Vector3d(0.6, -0.4, 0.3).normalized(), {8.0, 8.0, 8.0}};
    views[4].heldout = true;
    session = sphere_session(views, folder);
    FitOptions options = FitOptions::preset("draft");
    options.materials = 1;
    options.errors = ErrorSource::Given;
    options.normals = NormalChoice::Fitted;
    NoProgress progress;
    model = fit_model(session, options, {}, progress).model;
    records = lumitexel_records(model, session, progress);
  }

  json provenance() const { return json::parse(model.provenance_json); }
};

const FittedSphere& sphere() {
  static const FittedSphere fitted;
  return fitted;
}

std::size_t count_of(const LumitexelRecords& records, int verdict) {
  std::size_t sum = 0;
  for (const ViewRecords& view : records.by_view) sum += static_cast<std::size_t>(std::count(view.verdict.begin(), view.verdict.end(), verdict));
  return sum;
}

TEST(LumitexelRecords, AreTheSamplesThatTheFitSaw) {
  const LumitexelRecords& records = sphere().records;
  const json provenance = sphere().provenance(), rejected = provenance.at("rejected");
  EXPECT_EQ(records.used_views, (std::vector<std::size_t>{0, 1, 2, 3}));
  EXPECT_EQ(records.texel.size(), provenance.at("lumitexels").get<std::size_t>());
  const char* const kNames[] = {"outside_frame", "hidden", "in_shadow", "near_depth_edge", "near_shadow_edge", "grazing", "photograph_flag", "in_penumbra"};
  for (int verdict = 1; verdict <= 8; ++verdict) {
    EXPECT_EQ(count_of(records, verdict), rejected.at(kNames[verdict - 1]).get<std::size_t>()) << kNames[verdict - 1];
  }
  EXPECT_GT(count_of(records, 0), 5000u);
  // On the fitted normals, both times.
  EXPECT_EQ(count_of(records, 0), provenance.at("outliers").at("samples").get<std::size_t>());
  EXPECT_EQ(count_of(records, 0), provenance.at("samples").get<std::size_t>());
}

// The strongest that can be said of predictions and measurements together: the fit's own figure, but for the maps' single precision.
TEST(LumitexelRecords, HaveTheResidualThatTheFitReported) {
  const LumitexelRecords& records = sphere().records;
  double squares = 0.0;
  std::size_t values = 0;
  for (const ViewRecords& view : records.by_view) {
    for (std::size_t s = 0; s < view.measured.size(); ++s, ++values) {
      const double residual = static_cast<double>(view.measured[s]) - static_cast<double>(view.predicted[s]);
      squares += residual * residual;
    }
  }
  const double rms = std::sqrt(squares / static_cast<double>(values)), reported = sphere().provenance().at("rms").at("normal").get<double>();
  EXPECT_NEAR(rms, reported, 1e-4 * reported);
  EXPECT_GT(reported, 1e-5);
}

// In a bowl a third of the light comes from other surfaces. The fit saw samples without it and its model predicts them so; beside photographs that
// have it both are to have it, and what remains is what the fit's own residuals are, but for the scatter of eight paths a sample.
TEST(LumitexelRecords, LightBetweenSurfacesIsInBothColumns) {
  const TemporaryFolder folder;
  const CalibratedSession session = photographed_bowl(3, folder);
  FitOptions options = FitOptions::preset("draft");
  options.materials = 1;
  options.errors = ErrorSource::Given;
  options.interreflections.choice = InterreflectionChoice::Always;
  NoProgress progress;
  const Model model = fit_model(session, options, {}, progress).model;
  ASSERT_GT(model.indirect_bounces, 0);
  const LumitexelRecords records = lumitexel_records(model, session, progress);
  double measured = 0.0, predicted = 0.0, between = 0.0, squares = 0.0;
  std::size_t values = 0;
  for (std::size_t k = 0; k < records.used_views.size(); ++k) {
    const ViewRecords& view = records.by_view[k];
    for (std::size_t s = 0; s < view.measured.size(); ++s, ++values) {
      measured += static_cast<double>(view.measured[s]);
      predicted += static_cast<double>(view.predicted[s]);
      squares += std::pow(static_cast<double>(view.measured[s] - view.predicted[s]), 2);
    }
  }
  for (std::size_t i = 0; i < records.texel.size(); ++i) between += static_cast<double>(model.indirect.data[2 * records.texel[i] + 1]);
  between /= static_cast<double>(records.texel.size());
  EXPECT_GT(between, 0.15) << "else this says nothing";
  EXPECT_NEAR(predicted / measured, 1.0, 0.1 * between);
  const double rms = std::sqrt(squares / static_cast<double>(values)), mean = measured / static_cast<double>(values);
  EXPECT_LT(rms, 0.5 * between * mean);
}

TEST(LumitexelRecords, SharesOfALumitexelSumToOne) {
  const LumitexelRecords& records = sphere().records;
  ASSERT_TRUE(records.weighed);
  std::vector<double> sum(records.texel.size(), 0.0);
  std::vector<int> samples(records.texel.size(), 0);
  for (const ViewRecords& view : records.by_view) {
    std::size_t s = 0;
    for (std::size_t i = 0; i < sum.size(); ++i) {
      if (view.verdict[i] != 0) continue;
      sum[i] += static_cast<double>(view.share[s++]);
      ++samples[i];
    }
    EXPECT_EQ(s, view.share.size());
  }
  for (std::size_t i = 0; i < sum.size(); ++i) EXPECT_NEAR(sum[i], samples[i] > 0 ? 1.0 : 0.0, 1e-6);
}

TEST(LumitexelRecords, RefuseASessionThatTheModelWasNotFittedTo) {
  CalibratedSession other = sphere().session;
  other.key = "another";
  NoProgress progress;
  EXPECT_THROW(lumitexel_records(sphere().model, other, progress), BadInput);
}

TEST(ListedOutliers, AreReadBackAsTheyAreWritten) {
  Outliers outliers;
  outliers.worst = {{1, 0, OutlierReason::ExtraLight, 9.5, 0.5, 0.1}, {0, 1, OutlierReason::NoHighlight, 4.0, 0.1, 0.5}};
  const std::string csv = outliers_csv(outliers, {"a \"b\", c", "d"}, {7, 2305}, 100);
  const auto listed = listed_outliers(csv, 100);
  ASSERT_EQ(listed.size(), 2u);
  EXPECT_EQ(listed.at({"a \"b\", c", 2305u}), OutlierReason::ExtraLight);
  EXPECT_EQ(listed.at({"d", 7u}), OutlierReason::NoHighlight);
  EXPECT_EQ(listed_outliers(csv.substr(csv.find('\n') + 1), 100), listed) << "as it was written without the number of all outliers";
  EXPECT_THROW(listed_outliers("view\n\"a\",1,2,odd,1,1,1\n", 100), Corrupt);
  EXPECT_TRUE(listed_outliers("", 100).empty());
}

TEST(ViewerSamples, AreThinnedToTheSizeThatIsAllowed) {
  PackedChunks all, some;
  EXPECT_EQ(add_samples_within(100'000'000, sphere().records, sphere().model.mesh, all), 1u);
  const std::size_t most = all.total_bytes() / 3, every = add_samples_within(most, sphere().records, sphere().model.mesh, some);
  EXPECT_GE(every, 3u);
  EXPECT_LE(every, 5u);
  EXPECT_LE(some.total_bytes(), most);
}

// By a point's texels: the number of the nearest one, or blended over those that have the figure; -1 for none.
double figure_at(const TexturedPoint& point, const Model& model, const std::vector<float>& map, bool nearest) {
  double sum = 0.0, total = 0.0, best = 0.0, of_best = -1.0;
  for (int i = 0; i < point.texel_count; ++i) {
    const TexelShare& texel = point.texels[static_cast<std::size_t>(i)];
    const auto value = static_cast<double>(map[static_cast<std::size_t>(texel.y) * static_cast<std::size_t>(model.width) + static_cast<std::size_t>(texel.x)]);
    if (texel.weight > best) of_best = value;
    best = std::max(best, texel.weight);
    if (value < 0.0) continue;
    sum += texel.weight * value;
    total += texel.weight;
  }
  if (nearest) return of_best;
  return total > 0.0 ? sum / total : -1.0;
}

TEST(ViewerFigures, AreTheMapsAtEveryPixel) {
  if (!has_chromium()) GTEST_SKIP() << "NOT TESTED: no chromium here to open the viewer's page with";
  const FittedSphere& fitted = sphere();
  const TemporaryFolder folder;
  const ViewerSamples samples{fitted.session, fitted.records};
  std::ofstream(folder / "page.html", std::ios::binary) << viewer_page("sphere", fitted.model, &samples).html;
  // From the side: the photographs do not see all of this.
  const View view = framing_view(fitted.model.mesh, 3, 150, {0.4, 1.0, 0.2}, Eigen::Vector3d::UnitZ());
  const auto figures = browser_figures(folder / "page.html", view);
  ASSERT_TRUE(figures.has_value());
  const std::vector<float> maps[] = {fitted.model.uncertainty.data, fitted.model.samples.data, rms_residual(fitted.records, fitted.model), fitted.model.normal_sigma.data};
  const ModelSurface surface(fitted.model);
  const Eigen::Isometry3d world_from_camera = view.camera_from_world.inverse();
  int compared = 0, without = 0, other = 0;
  for (int y = 0; y < 150; ++y) {
    for (int x = 0; x < 150; ++x) {
      const auto point = surface.trace(world_from_camera.translation(), world_from_camera.linear() * view.camera.unproject({x + 0.5, y + 0.5}));
      if (!point || point->texel_count == 0) continue;
      for (std::size_t k = 0; k < 4; ++k) {
        const double expected = figure_at(*point, fitted.model, maps[k], k == 1);
        const auto found = static_cast<double>((*figures)[4 * static_cast<std::size_t>(y * 150 + x) + k]);
        ++compared;
        without += expected < 0.0;
        // Half floats; texels' borders, where single precision finds another texel, and the outline are allowed for below.
        other += std::abs(found - expected) > kHalfPrecision * std::abs(expected) + 1e-5;
      }
    }
  }
  EXPECT_GT(compared, 30000);
  EXPECT_GT(without, 1000);
  EXPECT_LT(without, compared / 4);
  EXPECT_LT(other, compared / 100);
}

// What the page says of one look, against the records and the camera.
void expect_look(const json& look, std::size_t k, std::size_t i) {
  const LumitexelRecords& records = sphere().records;
  const View& view = sphere().session.views[records.used_views[k]];
  const ViewRecords& of_view = records.by_view[k];
  EXPECT_EQ(look.at("view"), view.name);
  const Eigen::Vector3d& position = records.position[i];
  const Eigen::Vector2d pixel = view.camera.project(view.camera_from_world * position);
  // A position's step is 3e-6 m, which at 0.4 m is 0.002 pixels.
  EXPECT_NEAR(look.at("pixel")[0].get<double>(), pixel.x(), 0.01);
  EXPECT_NEAR(look.at("pixel")[1].get<double>(), pixel.y(), 0.01);
  const float* n = &sphere().model.normal.data[std::size_t{3} * records.texel[i]];
  const Eigen::Vector3d normal(n[0], n[1], n[2]);
  EXPECT_NEAR(std::cos(look.at("light").get<double>()), normal.dot(view.light.direction_from(position)), 2e-4);
  EXPECT_NEAR(std::cos(look.at("eye").get<double>()), normal.dot((view.camera_in_world() - position).normalized()), 2e-4);
  EXPECT_EQ(look.contains("measured"), of_view.verdict[i] == 0);
  if (of_view.verdict[i] != 0) return;
  const auto s = static_cast<std::size_t>(std::count(of_view.verdict.begin(), of_view.verdict.begin() + static_cast<std::ptrdiff_t>(i), 0));
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(look.at("measured")[c].get<double>(), static_cast<double>(of_view.measured[3 * s + c]), kHalfPrecision * 0.2);
    EXPECT_NEAR(look.at("predicted")[c].get<double>(), static_cast<double>(of_view.predicted[3 * s + c]), kHalfPrecision * 0.2);
  }
  EXPECT_NEAR(look.at("share").get<double>(), static_cast<double>(of_view.share[s]), 0.5 / 255 + 1e-6);
  EXPECT_NEAR(look.at("scales_off").get<double>(), static_cast<double>(of_view.scales_off[s]), kHalfPrecision * (1e-3 + static_cast<double>(of_view.scales_off[s])));
}

TEST(ViewerSamples, ThePageShowsThemAtEveryTexel) {
  if (!has_chromium()) GTEST_SKIP() << "NOT TESTED: no chromium here to open the viewer's page with";
  const LumitexelRecords& records = sphere().records;
  const TemporaryFolder folder;
  const ViewerSamples samples{sphere().session, records};
  std::ofstream(folder / "page.html", std::ios::binary) << viewer_page("sphere", sphere().model, &samples).html;
  std::vector<std::array<int, 2>> texels;
  std::vector<std::size_t> lumitexels;
  for (std::size_t i = 0; i < records.texel.size(); i += 97) {
    const auto texel = static_cast<int>(records.texel[i]);
    texels.push_back({texel % sphere().model.width, texel / sphere().model.width});
    lumitexels.push_back(i);
  }
  const auto said = browser_samples(folder / "page.html", sphere().session.views[0], texels);
  ASSERT_TRUE(said.has_value());
  ASSERT_EQ(said->size(), texels.size());
  ASSERT_GT(texels.size(), 20u);
  for (std::size_t t = 0; t < texels.size(); ++t) {
    EXPECT_EQ((*said)[t].at("texel"), json(texels[t]));
    EXPECT_EQ((*said)[t].at("distance"), 0.0);
    ASSERT_EQ((*said)[t].at("looks").size(), records.used_views.size());
    for (std::size_t k = 0; k < records.used_views.size(); ++k) expect_look((*said)[t].at("looks")[k], k, lumitexels[t]);
  }
}

}  // namespace
}  // namespace lumitexel
