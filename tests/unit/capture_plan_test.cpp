#include "rig/capture_plan.h"

#include <gtest/gtest.h>

#include "rig/schedule.h"
#include "rig/whole_file.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/small_rig.h"

namespace lumitexel {
namespace {

void expect_rejected(const std::string& from, const std::string& to, const std::string& place, const std::string& part) {
  EXPECT_BAD_INPUT(parse_plan(with_replaced(small_plan_toml(), from, to), "plan.toml"), place, part);
}

TEST(CapturePlan, ValuesLandWhereTheyBelong) {
  const CapturePlan plan = small_plan();
  ASSERT_EQ(plan.views.size(), 3u);
  EXPECT_EQ(plan.views[2].name, "heldout_000");
  EXPECT_TRUE(plan.views[2].heldout);
  EXPECT_FALSE(plan.views[0].heldout);
  EXPECT_EQ(plan.views[1].turntable_deg, 350.0);
  EXPECT_EQ(plan.views[1].light_azimuth_deg, 20.0);
  EXPECT_EQ(plan.views[1].light_elevation_deg, 30.0);
  EXPECT_EQ(plan.bracket_exposures_s, (std::vector<double>{0.01, 0.08}));
  EXPECT_EQ(plan.gray_card_exposures_s, (std::vector<double>{0.08, 0.64}));
  EXPECT_EQ(plan.spheres_point_exposure_s, 0.001);
  EXPECT_EQ(plan.gray_card_light_elevation_deg, 40.0);
}

TEST(CapturePlan, ThePlansThatComeWithItFitTheSimulatedRig) {
  const std::filesystem::path config = std::filesystem::path(LUMITEXEL_SOURCE_DIR) / "config";
  const RigDescription rig = parse_rig(read_whole_file(config / "rigs/simulated.toml"), "rig");
  for (const auto& [name, fit, heldout] : {std::tuple{"first_light", 20, 4}, std::tuple{"small", 8, 1}}) {
    const CapturePlan plan = parse_plan(read_whole_file(config / "plans" / (std::string(name) + ".toml")), name);
    int held = 0;
    for (const PlannedView& view : plan.views) held += view.heldout ? 1 : 0;
    EXPECT_EQ(held, heldout) << name;
    EXPECT_EQ(static_cast<int>(plan.views.size()) - held, fit) << name;
    EXPECT_FALSE(schedule_shots(plan, rig, name).empty());
  }
}

TEST(CapturePlan, MistakesAreNamedByFileLineAndKey) {
  expect_rejected("fit_001", "fit_000", "plan.toml:8: views[1].name: fit_000", "of its own");
  expect_rejected("fit_001", "../fit", "plan.toml:8: views[1].name: ../fit", "letters");
  expect_rejected("\"heldout\"", "\"test\"", "plan.toml:9: views[2].split: test", "heldout");
  expect_rejected("light_elevation_deg = 30.0", "light_elevation_deg = 95.0", "plan.toml:7: views[0].light_elevation_deg",
                  "-90 to 90");
  expect_rejected("turntable_deg = 350.0, ", "", "plan.toml:8: views[1].turntable_deg: missing", "number");
  expect_rejected("turntable_deg = 350.0", "turntable_deg = inf", "plan.toml:8: views[1].turntable_deg: inf", "number");
  expect_rejected("split = \"fit\", turntable_deg = 350.0", "split = \"fit\", zoom = 1, turntable_deg = 350.0",
                  "plan.toml:8: views[1].zoom: unknown key", "split");
  expect_rejected("[0.01, 0.08]", "[0.08, 0.01]", "plan.toml:13: exposures.bracket_s: not ascending", "short");
  expect_rejected("[0.01, 0.08]", "[]", "plan.toml:13: exposures.bracket_s", "at least one");
  expect_rejected("[0.01, 0.08]", "[0.0, 0.08]", "plan.toml:13: exposures.bracket_s", "positive");
  expect_rejected("darks_per_exposure = 2", "darks_per_exposure = 0", "plan.toml:4: darks_per_exposure: 0", "1 to");
  expect_rejected("mesh = \"scan\"\n", "", "mesh: missing", "string");
  EXPECT_BAD_INPUT(parse_plan("name = \"x\"\nmesh = ", "plan.toml"), "plan.toml:2");
}

TEST(CapturePlan, SomethingMustBeLeftToFit) {
  std::string text = small_plan_toml();
  for (int i = 0; i < 2; ++i) text = with_replaced(text, "split = \"fit\"", "split = \"heldout\"");
  EXPECT_BAD_INPUT(parse_plan(text, "plan.toml"), "plan.toml:6: views", "at least one");
}

}  // namespace
}  // namespace lumitexel
