// Plan, schedule and rig's file with what the lens calibration needs.
#include <gtest/gtest.h>

#include "rig/lighting.h"
#include "rig/rig_description.h"
#include "rig/schedule.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/small_rig.h"

namespace lumitexel {
namespace {

constexpr const char* kLens = R"toml(
[lens]
board_s = 0.01
board_placements = 3
flat_field_s = [0.02, 0.08]
flat_field_frames = 4
lamp_pattern_s = [0.01, 0.04]
light_azimuth_deg = 10.0
light_elevation_deg = 40.0
)toml";
constexpr const char* kLensAlone = "name = \"lens\"\ngain_db = 0.0\ndarks_per_exposure = 2\n";

constexpr const char* kTargets = R"toml(
[board]
pattern = "tag_grid"
columns = 4
rows = 3
pitch_m = 0.03
tag_size_m = 0.02
first_tag_id = 100
albedo = 0.8

[[tags]]
id = 7
size_m = 0.018
frame = "table"
centre_m = [0.1, 0.0, -0.09]
normal = [0.0, 0.0, 2.0]
up = [1.0, 0.0, 1.0]

[[tags]]
id = 20
size_m = 0.012
frame = "rig"
centre_m = [0.05, -0.16, -0.075]
normal = [0.8, 0.1, 0.6]
up = [0.0, 0.0, 1.0]
)toml";

std::string rig_toml() { return with_replaced(small_rig_toml(), "[gray_card]\n", "[gray_card]\ntag_ids = [20]\n") + kTargets; }
RigDescription rig_with_targets() { return parse_rig(rig_toml(), "bench.toml"); }

TEST(LensPlan, BoardsThenFlatFieldsThenTheViewsAsBefore) {
  const RigDescription rig = rig_with_targets();
  const std::vector<Shot> plain = schedule_shots(small_plan(), rig, "plan.toml");
  const std::vector<Shot> shots = schedule_shots(parse_plan(small_plan_toml() + kLens, "plan.toml"), rig, "plan.toml");
  const std::vector<std::pair<ShotKind, int>> first = {
      {ShotKind::Board, 1},     {ShotKind::LampPattern, 0}, {ShotKind::LampPattern, 1}, {ShotKind::Board, 2},
      {ShotKind::Board, 3},     {ShotKind::FlatField, 0},   {ShotKind::FlatField, 1},   {ShotKind::FlatField, 2},
      {ShotKind::FlatField, 3}, {ShotKind::FlatField, 0},   {ShotKind::FlatField, 1},   {ShotKind::FlatField, 2},
      {ShotKind::FlatField, 3}};
  ASSERT_GT(shots.size(), first.size() + plain.size() - 1);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(std::pair(shots[i].kind, shots[i].index), first[i]) << i;
  EXPECT_EQ(shots[1].light_azimuth_deg, 10.0);
  EXPECT_EQ(shots[12].camera.exposure_s, 0.08);
  for (std::size_t i = 0; plain[i].kind != ShotKind::Dark; ++i) {
    Shot shot = shots[first.size() + i];
    shot.id = plain[i].id;
    EXPECT_EQ(std::tuple(shot.kind, shot.view, shot.index, shot.turntable_deg, shot.light_azimuth_deg),
              std::tuple(plain[i].kind, plain[i].view, plain[i].index, plain[i].turntable_deg, plain[i].light_azimuth_deg));
    EXPECT_EQ(shot.camera, plain[i].camera);
  }
}

TEST(LensPlan, EveryExposureHasItsDarksAlsoWithoutViews) {
  const CapturePlan plan = parse_plan(std::string(kLensAlone) + kLens, "plan.toml");
  EXPECT_TRUE(plan.views.empty());
  const std::vector<Shot> shots = schedule_shots(plan, rig_with_targets(), "plan.toml");
  EXPECT_EQ(shots.size(), 3u + 2u + 8u + 2u * 4u);  // exposures 0.01, 0.02, 0.04, 0.08
  EXPECT_EQ(shots.back().kind, ShotKind::Dark);
}

TEST(LensPlan, LampsForTheNewKinds) {
  EXPECT_EQ(lighting_of(ShotKind::Board), (Lighting{false, true, false}));
  EXPECT_EQ(lighting_of(ShotKind::LampPattern), (Lighting{true, false, false}));
  EXPECT_EQ(lighting_of(ShotKind::FlatField), Lighting{});
  for (const ShotKind kind : {ShotKind::Board, ShotKind::FlatField, ShotKind::LampPattern}) {
    EXPECT_EQ(shot_kind_from_string(to_string(kind)), kind);
  }
}

TEST(LensPlan, MistakesAreNamed) {
  const auto parsed = [](const std::string& from, const std::string& to) {
    return parse_plan(with_replaced(std::string(kLensAlone) + kLens, from, to), "plan.toml");
  };
  EXPECT_BAD_INPUT(parsed("board_s = 0.01\nboard_placements = 3\n", ""), "lens.lamp_pattern_s", "board");
  EXPECT_BAD_INPUT(parsed("light_azimuth_deg = 10.0\n", ""), "lens.light_azimuth_deg: missing");
  EXPECT_BAD_INPUT(parsed("flat_field_frames = 4\n", ""), "lens.flat_field_frames: missing");
  EXPECT_BAD_INPUT(parsed("gain_db = 0.0\n", "gain_db = 0.0\nmesh = \"scan\"\n"), "mesh", "without views");
  EXPECT_BAD_INPUT(parse_plan(kLensAlone, "plan.toml"), "mesh: missing");
  const CapturePlan plan = parse_plan(std::string(kLensAlone) + kLens, "plan.toml");
  EXPECT_BAD_INPUT(schedule_shots(plan, small_rig(), "plan.toml"), "lens.board_placements", "[board]");
  CapturePlan far = plan;
  far.lens->light_azimuth_deg = 170;
  EXPECT_BAD_INPUT(schedule_shots(far, rig_with_targets(), "plan.toml"), "lens.light_azimuth_deg: 170", "reach");
}

TEST(RigTargets, TagsBoardAndTheCardsTagsAreRead) {
  const RigDescription rig = rig_with_targets();
  ASSERT_EQ(rig.tags.size(), 2u);
  EXPECT_TRUE(rig.tags[0].on_table);
  EXPECT_FALSE(rig.tags[1].on_table);
  EXPECT_NEAR((rig.tags[0].up - Eigen::Vector3d::UnitX()).norm(), 0.0, 1e-15);  // made normal to the tag's
  EXPECT_EQ(rig.gray_card.tag_ids, std::vector<int>{20});
  ASSERT_TRUE(rig.board);
  EXPECT_EQ(rig.board->pattern, BoardDescription::Pattern::TagGrid);
  EXPECT_EQ(rig.board->first_tag_id, 100);
}

TEST(RigTargets, MistakesAreNamed) {
  const auto parsed = [](const std::string& from, const std::string& to) {
    return parse_rig(with_replaced(rig_toml(), from, to), "bench.toml");
  };
  EXPECT_BAD_INPUT(parsed("id = 7", "id = 20"), "tags[1].id: 20", "of its own");
  EXPECT_BAD_INPUT(parsed("id = 7", "id = 587"), "tags[0].id: 587");
  EXPECT_BAD_INPUT(parsed("frame = \"table\"", "frame = \"moon\""), "tags[0].frame: moon", "table or rig");
  EXPECT_BAD_INPUT(parsed("up = [1.0, 0.0, 1.0]", "up = [0.0, 0.0, 1.0]"), "tags[0].up", "parallel");
  EXPECT_BAD_INPUT(parsed("tag_ids = [20]", "tag_ids = [7]"), "gray_card.tag_ids", "frame = \"rig\"");
  EXPECT_BAD_INPUT(parsed("tag_ids = [20]", "tag_ids = [3]"), "gray_card.tag_ids");
  EXPECT_BAD_INPUT(parsed("tag_size_m = 0.02", "tag_size_m = 0.029"), "board.tag_size_m", "margin");
  EXPECT_BAD_INPUT(parsed("first_tag_id = 100", "first_tag_id = 580"), "board.first_tag_id", "586");
  EXPECT_BAD_INPUT(parsed("pattern = \"tag_grid\"", "pattern = \"dots\""), "board.pattern: dots", "checkerboard");
}

}  // namespace
}  // namespace lumitexel
