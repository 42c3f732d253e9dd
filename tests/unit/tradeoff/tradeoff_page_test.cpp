#include "processing/report/tradeoff_page.h"

#include <gmock/gmock.h>

#include "processing/report/tradeoff_plot.h"
#include "tests/unit/tradeoff/made_measurements.h"

namespace lumitexel {
namespace {

using testing::HasSubstr;
using testing::Not;

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t found = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++found;
  return found;
}

Tradeoff three_settings() {
  Tradeoff tradeoff;
  tradeoff.measurements = {made_measurement("standard", 100, {0.1, 0.3}), made_measurement("quick<b>", 10, {0.2, 0.3}),
                           made_measurement("beaten", 120, {0.3, 0.3})};
  TradeoffMeasurement failed;
  failed.setting.name = "views-16";
  failed.failure = "the session has 8 photographs to fit";
  tradeoff.measurements.push_back(failed);
  return tradeoff;
}

TEST(TradeoffPlot, MarksAndNamesEveryMeasuredSettingAndDrawsTheFront) {
  const std::string svg = tradeoff_plot(three_settings());
  EXPECT_EQ(count(svg, "<circle"), 3u);
  EXPECT_EQ(count(svg, "r=\"5\" fill=\"#b4541a\""), 2u);  // the two on the front
  EXPECT_THAT(svg, HasSubstr("style=\"fill:#b4541a\">quick&lt;b&gt;</text>"));
  EXPECT_THAT(svg, HasSubstr("fill=\"none\" stroke=\"#b4541a\""));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("views-16")));
}

TEST(TradeoffPlot, OneSettingOrNoneIsNoTrouble) {
  Tradeoff tradeoff;
  EXPECT_EQ(tradeoff_plot(tradeoff), "");
  tradeoff.measurements = {made_measurement("draft", 10, {0.2})};
  const std::string svg = tradeoff_plot(tradeoff);
  EXPECT_EQ(count(svg, "<circle"), 1u);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
}

TEST(TradeoffPage, SaysWhyASettingWasNotMeasured) {
  const std::string page = tradeoff_page("bench", three_settings(), "{}");
  EXPECT_THAT(page, HasSubstr("views-16: the session has 8 photographs to fit"));
  EXPECT_THAT(page, HasSubstr("Against the standard preset"));
  EXPECT_THAT(page, Not(HasSubstr("quick<b>")));
}

}  // namespace
}  // namespace lumitexel
