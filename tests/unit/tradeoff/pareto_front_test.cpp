#include <gmock/gmock.h>

#include <cmath>

#include "tests/unit/tradeoff/made_measurements.h"

namespace lumitexel {
namespace {

constexpr double kRounding = 1e-12;

TEST(ParetoFront, HoldsWhatNothingBeatsInBothWays) {
  const std::vector<TradeoffMeasurement> measurements{
      made_measurement("slow and best", 100, {0.10}), made_measurement("beaten", 60, {0.30}), made_measurement("middle", 50, {0.20}),
      made_measurement("fast", 10, {0.40}), made_measurement("slower than middle, as good", 55, {0.20})};
  EXPECT_THAT(pareto_front(measurements), testing::ElementsAre(true, false, true, true, false));
}

TEST(ParetoFront, TwoAlikeAreBothOnIt) {
  EXPECT_THAT(pareto_front({made_measurement("a", 10, {0.2}), made_measurement("b", 10, {0.2})}), testing::Each(true));
}

TEST(ParetoFront, FailuresAndErrorsThatDoNotExistNeitherBeatNorBelong) {
  TradeoffMeasurement failed = made_measurement("failed", 0, {0.0});
  failed.failure = "the session has 8 photographs to fit";
  EXPECT_THAT(pareto_front({failed, made_measurement("nan", 1, {std::nan("")}), made_measurement("real", 10, {0.2})}),
              testing::ElementsAre(false, false, true));
}

TEST(TradeoffGain, IsPerSecondOfTheDifferenceAndItsSpreadThatOfTheDifferences) {
  Tradeoff tradeoff;
  tradeoff.measurements = {made_measurement("standard", 100, {0.10, 0.30}), made_measurement("slower", 300, {0.08, 0.26}),
                           made_measurement("faster", 50, {0.11, 0.31})};
  const auto slower = gain_over_standard(tradeoff, tradeoff.measurements[1]);
  ASSERT_TRUE(slower.has_value());
  EXPECT_NEAR(slower->gain.value, 0.03, kRounding);
  EXPECT_NEAR(slower->gain.sigma, 0.01, kRounding);  // of 0.02 and 0.04: far less than either error's own 0.1
  EXPECT_NEAR(slower->per_second, 0.03 / 200, kRounding);
  const auto faster = gain_over_standard(tradeoff, tradeoff.measurements[2]);
  EXPECT_NEAR(faster->gain.value, -0.01, kRounding);
  EXPECT_NEAR(faster->per_second, 0.01 / 50, kRounding);  // what a second saved costs
}

TEST(TradeoffGain, IsNotPerSecondWhereTimesAreAlike) {
  Tradeoff tradeoff;
  tradeoff.measurements = {made_measurement("standard", 100, {0.1, 0.3}), made_measurement("other", 104, {0.1, 0.2})};
  EXPECT_TRUE(std::isnan(gain_over_standard(tradeoff, tradeoff.measurements[1])->per_second));
}

TEST(TradeoffGain, DoesNotExistWithoutStandardOrForAFailure) {
  Tradeoff tradeoff;
  tradeoff.measurements = {made_measurement("draft", 10, {0.1})};
  EXPECT_FALSE(gain_over_standard(tradeoff, tradeoff.measurements[0]).has_value());
  tradeoff.measurements.push_back(made_measurement("standard", 20, {0.1}));
  tradeoff.measurements[0].failure = "no light";
  EXPECT_FALSE(gain_over_standard(tradeoff, tradeoff.measurements[0]).has_value());
}

}  // namespace
}  // namespace lumitexel
