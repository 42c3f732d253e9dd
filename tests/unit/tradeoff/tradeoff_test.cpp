#include "processing/fit/tradeoff.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "processing/fit/tradeoff_journal.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/sphere_session.h"

namespace lumitexel {
namespace {

View heldout(View view) {
  view.heldout = true;
  return view;
}

// A matte sphere: any setting predicts it.
CalibratedSession small_session(const TemporaryFolder& folder) {
  return sphere_session(
      {view_of_origin("a", {0.5, 0, 0}, {0.6, 0.4, 0.3}), view_of_origin("b", {0.45, 0.2, 0.1}, {0.6, -0.4, 0.3}),
       heldout(view_of_origin("x", {0.48, 0.1, 0.05}, {0.65, 0.1, 0.2})), view_of_origin("c", {0.45, -0.2, 0.1}, {0.7, 0.1, -0.3}),
       view_of_origin("d", {0.4, 0.1, 0.3}, {0.7, 0.1, 0.5}), heldout(view_of_origin("y", {0.48, -0.1, 0.05}, {0.65, -0.1, 0.2}))},
      folder);
}

// The last update of every stage, and whether any went backwards.
class RecordedProgress final : public Progress {
 public:
  void begin(const std::string&, std::int64_t steps, const std::string&) override {
    ++stages;
    total = steps;
  }
  void update(std::int64_t done) override {
    backwards = backwards || done < last;
    last = done;
  }
  void part(const std::string& name) override { parts.push_back(name); }
  int stages = 0;
  std::vector<std::string> parts;
  std::int64_t total = 0, last = 0;
  bool backwards = false;
};

TEST(Tradeoff, MeasuresEachSettingAndSaysWhyNotWhereItCannot) {
  const TemporaryFolder folder;
  std::vector<TradeoffSetting> settings = tradeoff_settings(1, false, {"draft", "views-16"});
  ASSERT_EQ(settings.size(), 2u);
  settings.push_back(settings.front());
  settings.back().fit_views = 3;
  RecordedProgress progress;
  const Tradeoff tradeoff = measure_tradeoff(small_session(folder), settings, 1, nullptr, progress);

  EXPECT_EQ(tradeoff.fit_views, 4u);
  EXPECT_EQ(tradeoff.heldout_views, 2u);
  ASSERT_EQ(tradeoff.measurements.size(), 3u);
  const TradeoffMeasurement& draft = tradeoff.measurements[0];
  ASSERT_TRUE(draft.measured()) << draft.failure;
  EXPECT_EQ(draft.runs.front().fit_views, 4u);
  EXPECT_EQ(draft.runs.front().materials, 1u);
  EXPECT_GT(draft.seconds, 0.0);
  EXPECT_GT(draft.cpu_seconds, 0.0);
  // No noise and one albedo: what is left is the silhouette, where a pixel's centre misses the mesh, and bilinear sampling.
  EXPECT_LT(draft.clipped.value, 0.05);
  EXPECT_EQ(draft.runs.front().clipped.by_view.size(), 2u);
  EXPECT_TRUE(std::isfinite(draft.clipped.sigma));
  EXPECT_THAT(tradeoff.measurements[1].failure, testing::HasSubstr("4 photographs"));
  EXPECT_EQ(tradeoff.measurements[2].runs.front().fit_views, 3u);

  EXPECT_EQ(progress.stages, 1);
  EXPECT_EQ(progress.last, progress.total);
  EXPECT_FALSE(progress.backwards);
  EXPECT_THAT(progress.parts, testing::ElementsAre("draft", "views-16", "draft"));

  const auto json = nlohmann::json::parse(tradeoff_json(tradeoff));
  EXPECT_EQ(json.at("settings").at(0).at("measured").at("heldout").at("clipped_rms").at("value"), draft.clipped.value);
  EXPECT_TRUE(json.at("settings").at(1).at("measured").is_null());
  EXPECT_FALSE(json.at("settings").at(1).at("failure").is_null());
}

// Materials fitted to other points are other materials, if only by the last digits.
TEST(Tradeoff, FitsEachSettingWithEachDraw) {
  const TemporaryFolder folder;
  std::vector<TradeoffSetting> settings = tradeoff_settings(1, false, {"draft", "errors-given"});
  for (TradeoffSetting& setting : settings) {
    setting.options = FitOptions::preset("draft");
    setting.options.materials = 1;
    setting.options.learning_lumitexels = setting.options.final_lumitexels = 100;  // of some thousand
  }
  settings[1].options.errors = ErrorSource::Given;
  TradeoffJournal journal(folder.path() / "kept.json", "a");
  RecordedProgress progress;
  const Tradeoff tradeoff = measure_tradeoff(small_session(folder), settings, 2, &journal, progress);
  EXPECT_EQ(tradeoff.draws, 2);
  EXPECT_FALSE(progress.backwards);
  EXPECT_EQ(progress.last, progress.total);
  for (std::size_t k = 0; k < settings.size(); ++k) {
    const TradeoffMeasurement& m = tradeoff.measurements[k];
    ASSERT_EQ(m.runs.size(), 2u);
    EXPECT_NE(m.runs[0].clipped.pooled, m.runs[1].clipped.pooled);
    EXPECT_GT(m.clipped.draw_deviation, 0.0);
    for (const int draw : {0, 1}) {
      settings[k].options.draw = draw;
      EXPECT_EQ(journal.known(settings[k])->clipped.pooled, m.runs[static_cast<std::size_t>(draw)].clipped.pooled);
    }
  }
  const std::vector<std::string> named{"draft, fit 1 of 2", "errors-given, fit 1 of 2", "draft, fit 2 of 2", "errors-given, fit 2 of 2"};
  EXPECT_EQ(progress.parts, named);
  for (TradeoffSetting& setting : settings) setting.options.draw = 0;
  const Tradeoff again = measure_tradeoff(small_session(folder), settings, 2, &journal, progress);
  EXPECT_EQ(tradeoff.known_before, 0u);
  EXPECT_EQ(again.known_before, 4u);
  EXPECT_EQ(progress.parts, named);  // nothing more
  EXPECT_EQ(again.measurements[1].clipped.value, tradeoff.measurements[1].clipped.value);
  const auto json = nlohmann::json::parse(tradeoff_json(tradeoff));
  EXPECT_EQ(json.at("settings").at(0).at("measured").at("draws").size(), 2u);
  EXPECT_TRUE(json.at("settings").at(0).at("against_standard").is_null());
}

TEST(Tradeoff, SaysWhatToDoWhereNothingIsHeldOut) {
  CalibratedSession session;
  session.views.resize(3);
  NoProgress progress;
  EXPECT_BAD_INPUT(measure_tradeoff(session, tradeoff_settings(4, false, {}), 1, nullptr, progress), "held out", "split", "lights.csv");
}

TEST(TradeoffSettings, AreTheNamedOnesAndTheReferenceOnlyIfAsked) {
  const auto names = [](const std::vector<TradeoffSetting>& settings) {
    std::vector<std::string> result;
    for (const TradeoffSetting& setting : settings) result.push_back(setting.name);
    return result;
  };
  EXPECT_THAT(names(tradeoff_settings(4, false, {"ggx", "draft"})), testing::ElementsAre("draft", "ggx"));
  EXPECT_THAT(names(tradeoff_settings(4, false, {})), testing::Not(testing::Contains("reference")));
  EXPECT_THAT(names(tradeoff_settings(4, true, {"draft"})), testing::ElementsAre("draft", "reference"));
  EXPECT_THAT(names(tradeoff_settings(4, false, {"reference"})), testing::ElementsAre("reference"));
  EXPECT_EQ(tradeoff_settings(7, false, {"paper"}).front().options.materials, 7);
  EXPECT_EQ(tradeoff_settings({}, false, {"paper"}).front().options.materials, kMaterialsOfThePaper);
  EXPECT_THAT(names(tradeoff_settings(0, true, {})), testing::Not(testing::Contains("paper")));  // it needs a number
  EXPECT_BAD_INPUT(tradeoff_settings(0, false, {"paper"}), "--materials", "paper");
  EXPECT_EQ(tradeoff_settings({}, false, {"standard"}).front().options.materials, 0);
  EXPECT_EQ(tradeoff_settings(6, false, {"materials-auto"}).front().options.materials, 0);
  EXPECT_EQ(tradeoff_settings({}, false, {"materials-8"}).front().options.materials, 8);
  EXPECT_BAD_INPUT(tradeoff_settings(4, false, {"fast"}), "fast", "learning-5000");
}

}  // namespace
}  // namespace lumitexel
