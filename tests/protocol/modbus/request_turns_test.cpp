#include "drivers/modbus/request_turns.h"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "drivers/clock.h"

namespace lumitexel {
namespace {

using Turn = RequestTurns::Turn;

TEST(RequestTurns, WhatIsUrgentComesBeforeAllThatHaveWaitedForLonger) {
  SystemClock clock;
  RequestTurns turns;
  std::mutex mutex;
  std::string order;
  const auto ask = [&](char name, bool urgent) {
    const Turn turn(turns, urgent, 10.0);
    const std::lock_guard lock(mutex);
    order += turn.taken() ? name : '?';
  };
  {
    std::vector<std::jthread> waiting;
    std::optional<Turn> held(std::in_place, turns, false, 10.0);
    for (int i = 0; i < 4; ++i) waiting.emplace_back(ask, 'n', false);
    clock.sleep_until(clock.now_s() + 0.05, {});
    for (int i = 0; i < 2; ++i) waiting.emplace_back(ask, 'u', true);
    clock.sleep_until(clock.now_s() + 0.05, {});
    held.reset();
  }
  EXPECT_EQ(order, "uunnnn");
}

TEST(RequestTurns, PatienceEndsAndLeavesTheTurnToOthers) {
  RequestTurns turns;
  {
    const Turn held(turns, false, 1.0);
    EXPECT_FALSE(Turn(turns, true, 0.02).taken());
    EXPECT_FALSE(Turn(turns, false, 0.02).taken());
  }
  EXPECT_TRUE(Turn(turns, false, 0.02).taken());
}

}  // namespace
}  // namespace lumitexel
