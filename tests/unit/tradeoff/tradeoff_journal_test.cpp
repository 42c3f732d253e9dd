#include "processing/fit/tradeoff_journal.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "processing/fit/tradeoff_json.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/temporary_folder.h"
#include "tests/unit/tradeoff/made_measurements.h"

namespace lumitexel {
namespace {

TradeoffRun some_run(double cpu_seconds) {
  TradeoffRun run = made_run(cpu_seconds, {0.1, 0.30000000000000004});
  run.materials = 3;
  run.fit_views = 12;
  run.relative.by_view[1] = std::nan("");
  return run;
}

TEST(TradeoffJournal, GivesBackWhatItWasGivenToTheLastBit) {
  const TemporaryFolder folder;
  const auto settings = tradeoff_settings(4, false, {"draft", "lobes-1"});
  const TradeoffRun first = some_run(10.1), second = some_run(1.0 / 3.0);
  {
    TradeoffJournal journal(folder.path() / "kept.json", "session and program");
    EXPECT_FALSE(journal.known(settings[0]).has_value());
    journal.keep(settings[0], first);
    journal.keep(settings[1], second);
  }
  const TradeoffJournal journal(folder.path() / "kept.json", "session and program");
  const auto known = journal.known(settings[1]);
  ASSERT_TRUE(known.has_value());
  EXPECT_EQ(run_json(*known), run_json(second));
  EXPECT_TRUE(std::isnan(known->relative.by_view[1]));
  EXPECT_EQ(run_json(*journal.known(settings[0])), run_json(first));
}

TEST(TradeoffJournal, KnowsNothingOfAnotherSessionProgramSettingOrDraw) {
  const TemporaryFolder folder;
  TradeoffSetting setting = tradeoff_settings(4, false, {"draft"}).front();
  TradeoffJournal journal(folder.path() / "kept.json", "a");
  journal.keep(setting, some_run(1.0));
  EXPECT_TRUE(journal.known(setting).has_value());
  EXPECT_FALSE(TradeoffJournal(folder.path() / "kept.json", "b").known(setting).has_value());
  setting.options.draw = 1;
  EXPECT_FALSE(journal.known(setting).has_value());
  setting.options.draw = 0;
  setting.options.materials = 5;
  EXPECT_FALSE(journal.known(setting).has_value());
  setting.options.materials = 4;
  setting.fit_views = 8;
  EXPECT_FALSE(journal.known(setting).has_value());
}

TEST(TradeoffJournal, DoesNotKeepFailures) {
  const TemporaryFolder folder;
  TradeoffRun failed = some_run(1.0);
  failed.failure = "no light";
  const TradeoffSetting setting = tradeoff_settings(4, false, {"draft"}).front();
  TradeoffJournal journal(folder.path() / "kept.json", "a");
  journal.keep(setting, failed);
  EXPECT_FALSE(journal.known(setting).has_value());
}

TEST(TradeoffJournal, RefusesAFileOfAnotherKind) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "model.json") << "{\"materials\": 4}";
  EXPECT_THROW(TradeoffJournal(folder.path() / "model.json", "a"), BadInput);
  std::ofstream(folder.path() / "odd.json") << "{\"tradeoff_measurements\": [1]}";
  EXPECT_THROW(TradeoffJournal(folder.path() / "odd.json", "a"), BadInput);
  EXPECT_THROW(TradeoffJournal(folder.path() / "nowhere" / "kept.json", "a"), Error);  // at once, not after the first fit
}

// Whatever a fit depends on has to be in the setting's JSON, or a journal takes one setting for another.
TEST(TradeoffJournal, SettingsAllDiffer) {
  const auto settings = tradeoff_settings(4, true, {});
  for (std::size_t i = 0; i < settings.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_NE(setting_json(settings[i]), setting_json(settings[j])) << settings[i].name << ' ' << settings[j].name;
  }
}

}  // namespace
}  // namespace lumitexel
