#include "rig/schedule.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <tuple>

#include "rig/capture_estimate.h"
#include "rig/motion_time.h"
#include "rig/view_order.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/small_rig.h"

namespace lumitexel {
namespace {

std::vector<Shot> small_schedule() { return schedule_shots(small_plan(), small_rig(), "plan.toml"); }

CapturePlan scattered_plan(int views) {
  CapturePlan plan = small_plan();
  plan.views.clear();
  for (int i = 0; i < views; ++i) {
    plan.views.push_back({"v" + std::to_string(i), false, i * 137.0 - 360.0 * (i * 137 / 360), -80.0 + i * 61 % 160,
                          5.0 + i * 29 % 70});
  }
  return plan;
}

TEST(Schedule, EveryViewHasItsShotsTogetherAtItsPlace) {
  const CapturePlan plan = scattered_plan(12);
  const std::vector<Shot> shots = schedule_shots(plan, small_rig(), "plan.toml");
  const std::vector<std::pair<ShotKind, int>> wanted = {{ShotKind::Silhouette, 0},
                                                        {ShotKind::SpheresRing, 0},
                                                        {ShotKind::SpheresPoint, 0},
                                                        {ShotKind::Object, 0},
                                                        {ShotKind::Object, 1}};
  for (const PlannedView& view : plan.views) {
    const auto first = std::find_if(shots.begin(), shots.end(), [&](const Shot& s) { return s.view == view.name; });
    ASSERT_GE(shots.end() - first, 5) << view.name;
    for (std::size_t i = 0; i < wanted.size(); ++i) {
      const Shot& shot = *(first + static_cast<std::ptrdiff_t>(i));
      EXPECT_EQ(shot.view, view.name);
      EXPECT_EQ(std::pair(shot.kind, shot.index), wanted[i]);
      EXPECT_EQ(position_of(shot),
                (RigPosition{view.turntable_deg, view.light_azimuth_deg, view.light_elevation_deg}));
    }
  }
}

TEST(Schedule, EveryExposureUsedHasItsDarksAndNoOther) {
  std::map<double, int> darks;
  std::set<double> used;
  for (const Shot& shot : small_schedule()) {
    if (shot.kind == ShotKind::Dark) {
      ++darks[shot.camera.exposure_s];
    } else {
      used.insert(shot.camera.exposure_s);
    }
  }
  EXPECT_EQ(used.size(), 5u);  // 0.001, 0.01 (twice in the plan), 0.02, 0.08 (twice), 0.64
  ASSERT_EQ(darks.size(), used.size());
  for (const double exposure_s : used) EXPECT_EQ(darks[exposure_s], 2) << exposure_s;
}

TEST(Schedule, NothingTwiceAndNumberedInOrder) {
  const std::vector<Shot> shots = small_schedule();
  EXPECT_EQ(shots.size(), 3u * 5u + 2u + 5u * 2u);
  std::set<std::tuple<ShotKind, std::string, int, double>> seen;
  std::int64_t id = 0;
  for (const Shot& shot : shots) {
    EXPECT_EQ(shot.id, ++id);
    const double exposure_s = shot.kind == ShotKind::Dark ? shot.camera.exposure_s : 0.0;
    EXPECT_TRUE(seen.insert({shot.kind, shot.view, shot.index, exposure_s}).second) << shot.id;
  }
}

// The plan gives the card the light of heldout_000.
TEST(Schedule, TheGrayCardIsShotUnderItsViewsLight) {
  const std::vector<Shot> shots = small_schedule();
  const auto card = std::find_if(shots.begin(), shots.end(), [](const Shot& s) { return s.kind == ShotKind::GrayCard; });
  ASSERT_NE(card, shots.end());
  EXPECT_EQ((card - 1)->view, "heldout_000");
  EXPECT_EQ(position_of(*card), position_of(*(card - 1)));
}

TEST(Schedule, ExposuresAreWhatTheCameraCanDo) {
  CapturePlan plan = small_plan();
  plan.bracket_exposures_s = {0.0100004, 0.08};
  for (const Shot& shot : schedule_shots(plan, small_rig(), "plan.toml")) {
    EXPECT_EQ(quantise(shot.camera, small_rig().camera.limits, "camera"), shot.camera);
    EXPECT_NE(shot.camera.exposure_s, 0.0100004);
  }
}

TEST(Schedule, WhatTheRigCannotDoIsNamed) {
  const auto scheduled = [](auto change) {
    CapturePlan plan = small_plan();
    change(plan);
    return schedule_shots(plan, small_rig(), "plan.toml");
  };
  EXPECT_BAD_INPUT(scheduled([](CapturePlan& p) { p.views[1].light_azimuth_deg = 111; }),
                   "plan.toml: views.fit_001.light_azimuth_deg: 111", "-110 to 110");
  EXPECT_BAD_INPUT(scheduled([](CapturePlan& p) { p.gray_card_light_elevation_deg = -30; }),
                   "plan.toml: gray_card.light_elevation_deg: -30");
  EXPECT_BAD_INPUT(scheduled([](CapturePlan& p) { p.bracket_exposures_s.back() = 31; }),
                   "plan.toml: exposures.bracket_s", "31");
  EXPECT_BAD_INPUT(scheduled([](CapturePlan& p) { p.silhouette_exposure_s = 1e-7; }), "exposures.silhouette_s");
  EXPECT_BAD_INPUT(scheduled([](CapturePlan& p) { p.gray_card_exposures_s = {0.0100001, 0.0100002}; }),
                   "exposures.gray_card_s", "same");
}

TEST(Schedule, QuantisingStaysWithinTheLimitsAndDoesNothingTwice) {
  CameraLimits limits;
  limits.exposure_min_s = 0.4;
  limits.exposure_max_s = 1.0;
  limits.exposure_step_s = 0.3;
  EXPECT_DOUBLE_EQ(quantise({0.40, 0}, limits, "c").exposure_s, 0.6);  // 0.3 is nearer, but below the limit
  EXPECT_DOUBLE_EQ(quantise({0.74, 0}, limits, "c").exposure_s, 0.6);
  EXPECT_DOUBLE_EQ(quantise({1.00, 0}, limits, "c").exposure_s, 0.9);
  limits = {6, 4, 12, Mosaic::Mono, 1e-5, 30.0, 1e-6, 0.15};
  for (double exposure_s = 1e-5; exposure_s < 30.0; exposure_s *= 1.37) {
    const CameraSettings once = quantise({exposure_s, 0}, limits, "c");
    EXPECT_NEAR(once.exposure_s, exposure_s, 0.5e-6 * (1 + 1e-9));
    EXPECT_EQ(quantise(once, limits, "c"), once);
  }
  EXPECT_EQ(quantise({30.0, 0}, limits, "c").exposure_s, 30.0);
  EXPECT_THROW(quantise({std::nan(""), 0}, limits, "c"), OutOfRange);
}

TEST(ViewOrder, IsAPermutationAndShorterThanThePlansOwn) {
  const RigDescription rig = small_rig();
  std::vector<RigPosition> positions;
  for (const PlannedView& view : scattered_plan(30).views) {
    positions.push_back({view.turntable_deg, view.light_azimuth_deg, view.light_elevation_deg});
  }
  const std::vector<std::size_t> order = short_order(positions, rig);
  EXPECT_EQ(std::set<std::size_t>(order.begin(), order.end()).size(), positions.size());
  double planned_s = 0, ordered_s = 0;
  RigPosition planned, ordered;
  for (std::size_t i = 0; i < order.size(); ++i) {
    planned_s += sequential_motion_s(planned, positions[i], rig);
    ordered_s += sequential_motion_s(ordered, positions[order[i]], rig);
    planned = positions[i];
    ordered = positions[order[i]];
  }
  EXPECT_LT(ordered_s, 0.7 * planned_s);  // scattered views have much to gain
}

TEST(ViewOrder, IsOptimalOnALine) {
  const RigDescription rig = small_rig();
  const std::vector<RigPosition> positions = {{60, 0, 0}, {20, 0, 0}, {100, 0, 0}, {5, 0, 0}, {80, 0, 0}};
  EXPECT_EQ(short_order(positions, rig), (std::vector<std::size_t>{3, 1, 0, 4, 2}));
}

// Against the best of all orders. Measured: 1.008; always going to the nearest, without improving on that, 1.026.
TEST(ViewOrder, IsNearlyOptimalForScatteredViews) {
  const RigDescription rig = small_rig();
  const auto length_s = [&](const std::vector<RigPosition>& positions, const std::vector<std::size_t>& order) {
    double sum_s = sequential_motion_s({}, positions[order[0]], rig);
    for (std::size_t i = 1; i < order.size(); ++i) sum_s += sequential_motion_s(positions[order[i - 1]], positions[order[i]], rig);
    return sum_s;
  };
  double sum_of_ratios = 0;
  constexpr int kSets = 8, kViews = 7;
  const std::vector<PlannedView> views = scattered_plan(kSets * kViews).views;
  for (int set = 0; set < kSets; ++set) {
    std::vector<RigPosition> positions;
    for (int i = 0; i < kViews; ++i) {
      const PlannedView& view = views[static_cast<std::size_t>(set * kViews + i)];
      positions.push_back({view.turntable_deg, view.light_azimuth_deg, view.light_elevation_deg});
    }
    std::vector<std::size_t> order(positions.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    double best_s = length_s(positions, order);
    while (std::next_permutation(order.begin(), order.end())) best_s = std::min(best_s, length_s(positions, order));
    sum_of_ratios += length_s(positions, short_order(positions, rig)) / best_s;
  }
  RecordProperty("ratio", std::to_string(sum_of_ratios / kSets));
  EXPECT_LT(sum_of_ratios / kSets, 1.015);
}

TEST(CaptureEstimate, AddsUpByHand) {
  const RigDescription rig = small_rig();  // 20 deg/s and 0.5 s, 15 deg/s and 0.8 s, readout 0.15 s
  std::vector<Shot> shots(3);
  shots[0].camera.exposure_s = 1.0;
  shots[0].turntable_deg = 350.0;  // 10 deg the short way: 0.5 s + 0.5 s
  shots[1] = shots[0];
  shots[2] = shots[0];
  shots[2].light_azimuth_deg = 30.0;    // 2 s + 0.8 s
  shots[2].light_elevation_deg = 15.0;  // 1 s + 0.8 s
  const CaptureEstimate estimate = estimate_capture(shots, rig);
  EXPECT_NEAR(estimate.estimate_s, 3 * 1.15 + 1.0 + 2.8 + 1.8, 1e-12);
  EXPECT_NEAR(estimate.lower_bound_s, 3 * 1.15 + 2.0, 1e-12);
  // P5, the mosaic's comment, "6 4", "4095", each with its line end; then two bytes a sample.
  EXPECT_EQ(estimate.bytes, 3 * (3 + 24 + 4 + 5 + 48));
}

// Against every order of visiting, on all axes at once.
TEST(CaptureEstimate, TheLowerBoundIsBelowEveryOrder) {
  const RigDescription rig = small_rig();
  const CapturePlan plan = scattered_plan(7);
  const std::vector<Shot> shots = schedule_shots(plan, rig, "plan.toml");
  std::vector<RigPosition> positions;
  for (const PlannedView& view : plan.views) {
    positions.push_back({view.turntable_deg, view.light_azimuth_deg, view.light_elevation_deg});
  }
  positions.push_back({});  // the card's, filled in below
  for (const Shot& shot : shots) {
    if (shot.kind == ShotKind::GrayCard) positions.back() = position_of(shot);
  }
  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  double best_s = 1e9;
  do {
    double sum_s = 0;
    for (std::size_t i = 1; i < order.size(); ++i) sum_s += fastest_motion_s(positions[order[i - 1]], positions[order[i]], rig);
    best_s = std::min(best_s, sum_s);
  } while (std::next_permutation(order.begin(), order.end()));
  const CaptureEstimate estimate = estimate_capture(shots, rig);
  EXPECT_LE(estimate.shortest_motion_s, best_s + 1e-9);
  EXPECT_GT(estimate.shortest_motion_s, 0.5 * best_s);  // a bound that says something
  EXPECT_LT(estimate.lower_bound_s, estimate.estimate_s);
}

}  // namespace
}  // namespace lumitexel
