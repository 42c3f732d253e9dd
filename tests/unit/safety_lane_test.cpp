#include "rig/safety_lane.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lumitexel {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

struct Log {
  std::atomic<int> safe_calls = 0, kicks = 0;
  std::atomic<bool> answers = true, hangs = false, hears = true;
};

class LoggingChannel final : public SafetyChannel {
 public:
  LoggingChannel(std::string name, Log& log) : name_(std::move(name)), log_(log) {}
  std::string name() const override { return name_; }
  bool make_safe() noexcept override {
    ++log_.safe_calls;
    while (log_.hangs) std::this_thread::yield();
    return log_.answers;
  }
  bool keep_alive() noexcept override {
    ++log_.kicks;
    return log_.hears;
  }

 private:
  std::string name_;
  Log& log_;
};

class SafetyLaneTest : public testing::Test {
 protected:
  std::unique_ptr<SafetyLane> lane() {
    std::vector<std::unique_ptr<SafetyChannel>> channels;
    channels.push_back(std::make_unique<LoggingChannel>("table", table_));
    channels.push_back(std::make_unique<LoggingChannel>("lamps", lamps_));
    return std::make_unique<SafetyLane>(std::move(channels), 10ms);
  }
  static bool within(std::chrono::milliseconds time, const std::function<bool()>& holds) {
    const auto end = std::chrono::steady_clock::now() + time;
    while (!holds() && std::chrono::steady_clock::now() < end) std::this_thread::yield();
    return holds();
  }
  Log table_, lamps_;
};

TEST_F(SafetyLaneTest, WatchesAndFeedsTheWatchdogsUntilItTrips) {
  const auto lane = this->lane();
  EXPECT_TRUE(within(5s, [&] { return table_.kicks > 3 && lamps_.kicks > 3; }));
  EXPECT_EQ(table_.safe_calls, 0);
  EXPECT_FALSE(lane->is_tripped());
  lane->trip("door open");
  lane->trip("second cause");
  EXPECT_THAT(lane->wait_until_safe(5s), IsEmpty());
  EXPECT_EQ(lane->cause(), "door open");
  EXPECT_GE(table_.safe_calls, 1);
  EXPECT_GE(lamps_.safe_calls, 1);
}

TEST_F(SafetyLaneTest, ADeadControllerKeepsNoOtherWaitingAndIsNamed) {
  table_.hangs = true;
  const auto lane = this->lane();
  lane->trip("test");
  EXPECT_TRUE(within(5s, [&] { return lamps_.safe_calls >= 1; }));
  EXPECT_THAT(lane->wait_until_safe(50ms), ElementsAre("table"));
  table_.hangs = false;
  EXPECT_THAT(lane->wait_until_safe(5s), IsEmpty());
}

TEST_F(SafetyLaneTest, WhatIsNotAcknowledgedIsTriedAgain) {
  lamps_.answers = false;
  const auto lane = this->lane();
  lane->trip("test");
  EXPECT_TRUE(within(5s, [&] { return lamps_.safe_calls >= 3; }));
  EXPECT_THAT(lane->wait_until_safe(10ms), ElementsAre("lamps"));
  lamps_.answers = true;
  EXPECT_THAT(lane->wait_until_safe(5s), IsEmpty());
}

TEST_F(SafetyLaneTest, NoSignOfLifeInTimeTripsAndSaysWhatHung) {
  const auto lane = this->lane();
  std::atomic<bool> told = false;
  lane->on_trip([&] { told = true; });
  lane->expect_life_within(20ms, "storing the frame of shot 7");
  EXPECT_TRUE(within(5s, [&] { return told.load(); }));
  EXPECT_THAT(lane->cause(), HasSubstr("storing the frame of shot 7 has taken more than 0.02 s"));
  EXPECT_THAT(lane->wait_until_safe(5s), IsEmpty());
}

TEST_F(SafetyLaneTest, SignsOfLifeInTimeKeepItWatching) {
  const auto lane = this->lane();
  lane->expect_life_within(10s, "first");
  lane->expect_life_within(0s, "nothing");
  EXPECT_FALSE(within(50ms, [&] { return lane->is_tripped(); }));
}

TEST_F(SafetyLaneTest, AControllerThatHasGoneDeafTripsIt) {
  lamps_.hears = false;
  const auto lane = this->lane();
  EXPECT_TRUE(within(10s, [&] { return lane->is_tripped(); }));
  EXPECT_THAT(lane->cause(), HasSubstr("lamps no longer answers its safety connection"));
  EXPECT_THAT(lane->wait_until_safe(5s), IsEmpty());
}

TEST_F(SafetyLaneTest, LettingGoMakesSafeOnceMoreAlsoAfterATrip) {
  {
    const auto lane = this->lane();
    lane->trip("test");
    EXPECT_THAT(lane->wait_until_safe(5s), IsEmpty());
    table_.safe_calls = lamps_.safe_calls = 0;
  }
  EXPECT_GE(table_.safe_calls, 1);
  EXPECT_GE(lamps_.safe_calls, 1);
}

TEST_F(SafetyLaneTest, AfterAResetItWatchesAgain) {
  const auto lane = this->lane();
  lane->trip("test");
  lane->wait_until_safe(5s);
  lane->reset();
  EXPECT_FALSE(lane->is_tripped());
  const int kicks = table_.kicks;
  EXPECT_TRUE(within(5s, [&] { return table_.kicks > kicks; }));
}

TEST_F(SafetyLaneTest, TrippedRightAfterAResetItActsAtOnce) {
  const auto lane = this->lane();
  for (int i = 1; i <= 20; ++i) {
    std::atomic<bool> told = false;
    lane->on_trip([&] { told = true; });
    const int calls = table_.safe_calls;
    lane->trip("test");
    EXPECT_TRUE(within(500ms, [&] { return table_.safe_calls > calls && told; })) << "trip " << i;
    EXPECT_THAT(lane->wait_until_safe(5s), IsEmpty());
    lane->on_trip({});
    lane->reset();
  }
}

TEST_F(SafetyLaneTest, LettingGoOfTheRigLeavesItSafe) {
  this->lane().reset();
  EXPECT_GE(table_.safe_calls, 1);
  EXPECT_GE(lamps_.safe_calls, 1);
}

}  // namespace
}  // namespace lumitexel
