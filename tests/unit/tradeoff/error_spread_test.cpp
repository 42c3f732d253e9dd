#include "processing/fit/error_spread.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/unit/tradeoff/made_measurements.h"

namespace lumitexel {
namespace {

constexpr double kRounding = 1e-12;

TEST(ErrorSpread, OfOneDrawIsTheStandardErrorOverViews) {
  const ErrorWithSpread error = over_draws({{2.6, {1, 2, 3, 4}}});
  EXPECT_NEAR(error.value, 2.6, kRounding);                           // pooled, not the views' mean
  EXPECT_NEAR(error.sigma, std::sqrt(5.0 / 3.0 / 4.0), kRounding);
  EXPECT_TRUE(std::isnan(error.draw_deviation));
}

TEST(ErrorSpread, AddsWhatDrawsSay) {
  // Views differ by 2, draws by 1, nothing else.
  const ErrorWithSpread error = over_draws({{2.0, {1, 3}}, {3.0, {2, 4}}});
  EXPECT_NEAR(error.value, 2.5, kRounding);
  EXPECT_NEAR(error.draw_deviation, std::sqrt(0.5), kRounding);
  EXPECT_NEAR(error.sigma, std::sqrt(2.0 / 2.0 + 0.5 / 2.0), kRounding);
}

TEST(ErrorSpread, OfAViewOrNoneIsNoNumber) {
  EXPECT_TRUE(std::isnan(over_draws({{1.0, {1}}}).sigma));
  EXPECT_TRUE(std::isnan(over_draws({{1.0, {1}}, {2.0, {2}}}).sigma));
  EXPECT_TRUE(std::isnan(over_draws({}).value));
}

// Errors made of a part by view, one by draw and one by both; the true error of a mean over 6 views and 4 draws is known. Sigma may be
// too large (it counts the last part twice), and with six views a quarter of chance.
TEST(ErrorSpread, SigmaIsTheScatterOfRepeatedExperiments) {
  constexpr int kExperiments = 2000, kViews = 6, kDraws = 4;
  constexpr double kByView = 0.05, kByDraw = 0.02, kByBoth = 0.01;
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  double scatter = 0.0, claimed = 0.0;
  for (int e = 0; e < kExperiments; ++e) {
    std::vector<double> of_view(kViews);
    for (double& value : of_view) value = kByView * normal(random);
    std::vector<HeldoutError> draws;
    for (int r = 0; r < kDraws; ++r) {
      HeldoutError draw{0.0, of_view};
      const double of_draw = kByDraw * normal(random);
      for (double& value : draw.by_view) {
        value += of_draw + kByBoth * normal(random);
        draw.pooled += value / kViews;
      }
      draws.push_back(draw);
    }
    const ErrorWithSpread error = over_draws(draws);
    scatter += error.value * error.value / kExperiments;
    claimed += error.sigma * error.sigma / kExperiments;
  }
  // Both squares are means over 2,000 of what varies by its own size and more: 5 % of the root is three standard errors or so.
  EXPECT_NEAR(std::sqrt(claimed / scatter), 1.0, 0.05);
}

// What settings share, by view and by draw, is no part of their difference.
TEST(ErrorSpread, OfDifferencesLeavesOutWhatIsShared) {
  const HeldoutError first_a{2.0, {1, 3}}, first_b{1.9, {0.9, 2.9}}, second_a{3.0, {2, 4}}, second_b{2.9, {1.9, 3.9}};
  const ErrorWithSpread gain = over_draws({difference(first_a, first_b), difference(second_a, second_b)});
  EXPECT_NEAR(gain.value, 0.1, kRounding);
  EXPECT_NEAR(gain.sigma, 0.0, 1e-7);  // roots of rounding
}

TEST(TradeoffMeasurement, SumsUpItsDraws) {
  TradeoffRun first = made_run(10, {0.1, 0.3}), second = made_run(20, {0.2, 0.4});
  first.materials = 20;
  second.materials = 17;
  first.peak_bytes = 100;
  second.peak_bytes = 90;
  const TradeoffMeasurement measurement = summed_up({}, {first, second});
  EXPECT_NEAR(measurement.cpu_seconds, 15.0, kRounding);
  EXPECT_EQ(measurement.peak_bytes, 100);
  EXPECT_EQ(materials_text(measurement), "17-20");
  EXPECT_EQ(materials_text(summed_up({}, {first})), "20");
  EXPECT_NEAR(measurement.clipped.value, 0.25, kRounding);
}

TEST(TradeoffMeasurement, FailsWithAnyOfItsDraws) {
  TradeoffRun failed;
  failed.failure = "no light";
  const TradeoffMeasurement measurement = summed_up({}, {made_run(10, {0.1, 0.3}), failed});
  EXPECT_EQ(measurement.failure, "no light");
  EXPECT_TRUE(std::isnan(measurement.clipped.value));
}

}  // namespace
}  // namespace lumitexel
