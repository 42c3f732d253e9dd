// What Axis::move_to() and Lamp::switch_to() promise, whatever the driver under them does.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "drivers/error.h"
#include "drivers/light.h"
#include "drivers/motion.h"

namespace lumitexel {
namespace {

using testing::HasSubstr;

class ScriptedAxis final : public Axis {
 public:
  explicit ScriptedAxis(std::shared_ptr<Clock> clock) : Axis(std::move(clock)) {
    limits_.min = -180.0;
    limits_.max = 180.0;
    limits_.speed = 10.0;
    limits_.settle_s = 0.4;
  }
  std::string name() const override { return "scripted axis"; }
  AxisLimits limits() const override { return limits_; }
  void halt() noexcept override { ++halts; }

  AxisLimits limits_;
  std::function<AxisReading(double target, double since_start_s)> reads = [](double to, double) {
    return AxisReading{to, false, {}};
  };
  double target = 0.0, started_s = 0.0;
  int starts = 0, halts = 0;

 protected:
  void start(double to, std::stop_token) override {
    ++starts;
    target = to;
    started_s = clock().now_s();
  }
  AxisReading read() const override {
    return starts == 0 ? AxisReading{0.0, false, {}} : reads(target, clock().now_s() - started_s);
  }
};

class AxisContract : public testing::Test {
 protected:
  std::shared_ptr<VirtualClock> clock_ = std::make_shared<VirtualClock>();
  ScriptedAxis axis_{clock_};

  void expect_timeout_at(double target) {
    try {
      axis_.move_to(target, {});
      ADD_FAILURE() << "arrived";
    } catch (const Timeout& error) {
      EXPECT_THAT(error.what(), HasSubstr("scripted axis: sent to"));
    }
    EXPECT_EQ(axis_.halts, 1);
  }
};

TEST_F(AxisContract, ArrivedIsAtTheTargetAndStillForTheSettleTime) {
  axis_.move_to(90.0, {});
  EXPECT_NEAR(clock_->now_s(), 9.0 + 0.4, 1e-9);
  EXPECT_EQ(axis_.halts, 0);
}

TEST_F(AxisContract, AnAxisThatIsThereAlreadyIsNotMoved) {
  axis_.move_to(0.0, {});
  EXPECT_EQ(axis_.starts, 0);
}

TEST_F(AxisContract, ASwingAboutTheTargetIsWaitedFor) {
  // 2 degrees, dying away within 0.1 s: inside the tolerance of 0.01 after about 0.53 s.
  axis_.reads = [](double target, double since_s) {
    const double swing = since_s < 9.0 ? 0.0 : 2.0 * std::exp(-(since_s - 9.0) / 0.1) * std::cos(40.0 * since_s);
    return AxisReading{target + swing, false, {}};
  };
  axis_.move_to(90.0, {});
  EXPECT_GT(clock_->now_s(), 9.0 + 0.4 + 0.3);
  EXPECT_LT(clock_->now_s(), 9.0 + 0.4 + 0.7);
}

TEST_F(AxisContract, AnAxisThatSaysItMovesHasNotArrivedEvenOnTheSpot) {
  axis_.reads = [](double target, double since_s) { return AxisReading{target, since_s < 9.5, {}}; };
  axis_.move_to(90.0, {});
  EXPECT_GE(clock_->now_s(), 9.5 + 0.4);
}

TEST_F(AxisContract, AStuckAxisIsATimeoutAndIsHalted) {
  axis_.reads = [](double target, double) { return AxisReading{target - 1.0, false, {}}; };
  expect_timeout_at(90.0);
  EXPECT_LT(clock_->now_s(), 9.0 * 1.5 + 0.4 + 2.0 + 0.1);
}

TEST_F(AxisContract, AnAxisThatCreepsNeverRests) {
  axis_.reads = [](double target, double since_s) {
    return AxisReading{target + 0.009 * std::sin(20.0 * since_s), false, {}};
  };
  expect_timeout_at(90.0);
}

TEST_F(AxisContract, AFaultThatTheDeviceReportsEndsTheMotionEarly) {
  axis_.reads = [](double target, double since_s) {
    return AxisReading{target, true, since_s > 3.0 ? "limit switch" : ""};
  };
  try {
    axis_.move_to(90.0, {});
    FAIL();
  } catch (const Protocol& error) {
    EXPECT_THAT(error.what(), HasSubstr("scripted axis: limit switch"));
  }
  EXPECT_LT(clock_->now_s(), 4.0);
  EXPECT_EQ(axis_.halts, 1);
}

TEST_F(AxisContract, APositionThatIsNotANumberIsAFault) {
  axis_.reads = [](double, double) { return AxisReading{std::nan(""), false, {}}; };
  EXPECT_THROW(axis_.move_to(90.0, {}), Protocol);
}

TEST_F(AxisContract, OutOfRangeIsRefusedBeforeMoving) {
  for (const double target : {180.1, -180.1, std::nan(""), double(INFINITY)}) {
    EXPECT_THROW(axis_.move_to(target, {}), OutOfRange) << target;
  }
  EXPECT_EQ(axis_.starts, 0);
  EXPECT_EQ(axis_.halts, 0);
}

TEST_F(AxisContract, AWrappingAxisTakesAnyTurnAndTheShortWay) {
  axis_.limits_.min = 0.0;
  axis_.limits_.max = 360.0;
  axis_.limits_.wraps = true;
  axis_.move_to(710.0, {});
  EXPECT_EQ(axis_.target, 350.0);
  EXPECT_NEAR(clock_->now_s(), 1.0 + 0.4, 1e-9);
}

TEST_F(AxisContract, ACancelHalts) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_THROW(axis_.move_to(90.0, stop.get_token()), Cancelled);
  EXPECT_EQ(axis_.halts, 1);
}

class ScriptedLamp final : public Lamp {
 public:
  explicit ScriptedLamp(std::shared_ptr<Clock> clock) : Lamp(std::move(clock), 0.3) {}
  std::string name() const override { return "scripted lamp"; }
  bool is_on() const override { return commanded_ && !broken && clock().now_s() >= commanded_s_ + delay_s; }
  void force_off() noexcept override { commanded_ = false; }
  bool broken = false;
  double delay_s = 0.0;
  int commands = 0;

 protected:
  void command(bool on, std::stop_token) override {
    ++commands;
    commanded_ = on;
    commanded_s_ = clock().now_s();
  }

 private:
  bool commanded_ = false;
  double commanded_s_ = 0.0;
};

TEST(LampContract, ReturnsWhenTheLampSaysSoAndItsLightIsSteady) {
  const auto clock = std::make_shared<VirtualClock>();
  ScriptedLamp lamp(clock);
  lamp.delay_s = 0.5;
  lamp.switch_to(true, {});
  EXPECT_NEAR(clock->now_s(), 0.5 + 0.3, 0.011);
  lamp.switch_to(true, {});
  EXPECT_EQ(lamp.commands, 1);
}

TEST(LampContract, ALampThatStaysDarkIsATimeoutThatNamesIt) {
  const auto clock = std::make_shared<VirtualClock>();
  ScriptedLamp lamp(clock);
  lamp.broken = true;
  try {
    lamp.switch_to(true, {});
    FAIL();
  } catch (const Timeout& error) {
    EXPECT_THAT(error.what(), HasSubstr("scripted lamp: switched on, but still says that it is off"));
  }
  EXPECT_LT(clock->now_s(), 1.1);
}

}  // namespace
}  // namespace lumitexel
