#include "rig/view_selection.h"

#include <gtest/gtest.h>

#include "rig/capture_plan.h"
#include "rig/reduced_plan.h"
#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/small_rig.h"

namespace lumitexel {
namespace {

using Strings = std::vector<std::string>;

const std::vector<SelectableView> kViews = {{"fit_a"}, {"held", true}, {"fit_b"}, {"c.exr"}, {"2"}};

Strings kept(const Strings& without, const Strings& only = {}) {
  return select_views(kViews, {without, only}).kept;
}

TEST(ViewSelection, TakesNamesIndicesAndRanges) {
  EXPECT_EQ(kept({}), (Strings{"fit_a", "held", "fit_b", "c.exr", "2"}));
  EXPECT_TRUE(select_views(kViews, {}).everything());
  EXPECT_EQ(kept({"view=0"}), (Strings{"held", "fit_b", "c.exr", "2"}));
  EXPECT_EQ(kept({"view=fit_b"}), (Strings{"fit_a", "held", "c.exr", "2"}));
  EXPECT_EQ(kept({"view=c"}), (Strings{"fit_a", "held", "fit_b", "2"}));
  EXPECT_EQ(kept({"view=2"}), (Strings{"fit_a", "held", "fit_b", "c.exr"}));  // its name before its index
  EXPECT_EQ(kept({"views=1..3"}), (Strings{"fit_a", "2"}));
  EXPECT_EQ(kept({"views=0,3..4"}), (Strings{"held", "fit_b"}));
  EXPECT_EQ(kept({"view=0", "view=1"}), (Strings{"fit_b", "c.exr", "2"}));
  EXPECT_EQ(kept({}, {"views=0..1", "view=4"}), (Strings{"fit_a", "held", "2"}));
  EXPECT_EQ(kept({"view=held"}, {"views=0..2"}), (Strings{"fit_a", "fit_b"}));
  EXPECT_EQ(select_views(kViews, {{"views=1..3"}, {}}).left_out, (Strings{"held", "fit_b", "c.exr"}));
}

TEST(ViewSelection, AnExtensionMayBeLeftOutOrStandThere) {
  const Strings names{"fit_a", "c.exr", "d.exr", "d.png", "pose.1"};
  EXPECT_EQ(view_named("--view", "c", names), 1u);
  EXPECT_EQ(view_named("--view", "c.exr", names), 1u);
  EXPECT_EQ(view_named("--view", "fit_a.exr", names), 0u);
  EXPECT_EQ(view_named("--view", "d.png", names), 3u);  // exactly that one
  EXPECT_EQ(view_named("--view", "pose.1", names), 4u);
  EXPECT_BAD_INPUT(view_named("--view", "d", names), "--view", "d.exr or d.png");
  EXPECT_BAD_INPUT(view_named("--view", "c.png", names), "--view", "no view 'c.png'", "fit_a, c.exr");
  EXPECT_BAD_INPUT(view_named("--view", "pose", names), "no view 'pose'");
  EXPECT_EQ(kept({"view=fit_b.exr"}), (Strings{"fit_a", "held", "c.exr", "2"}));
}

TEST(ViewSelection, TakesKindsToLeaveOut) {
  const ViewSelection selection = select_views(kViews, {{"kind=dark,gray_card"}, {}});
  EXPECT_EQ(selection.kinds_left_out, (std::set{ShotKind::Dark, ShotKind::GrayCard}));
  EXPECT_EQ(selection.kept.size(), kViews.size());
  EXPECT_FALSE(selection.everything());
}

TEST(ViewSelection, SaysWhatThereIsWhenAskedForSomethingElse) {
  for (const char* bad :
       {"view=5", "view=fit_c", "views=3..5", "views=2..1", "views=0..", "view=", "view=-1", "view=0,"}) {
    EXPECT_BAD_INPUT(kept({bad}), "--without", "0 fit_a, 1 held (held out), 2 fit_b");
    EXPECT_BAD_INPUT(kept({}, {bad}), "--only", "0 fit_a, 1 held (held out), 2 fit_b");
  }
  EXPECT_BAD_INPUT(kept({"kind=flash"}), "--without", "flash", "silhouette");
  EXPECT_BAD_INPUT(kept({}, {"kind=dark"}), "--only", "kind=dark", "view");
  EXPECT_BAD_INPUT(kept({"7"}), "--without", "'7'", "view=");
  EXPECT_BAD_INPUT(kept({"shot=7"}), "--without", "shot=7", "kind=");
}

TEST(ViewSelection, LeavesAViewToFit) {
  EXPECT_BAD_INPUT(kept({}, {"view=held"}), "no view to fit", "0 fit_a");
  EXPECT_BAD_INPUT(kept({"views=0..4"}), "no view to fit");
}

TEST(ReducedPlan, IsThePlanWithFewerViews) {
  const std::string text =
      with_replaced(small_plan_toml(), "turntable_deg = 10.0", "turntable_deg = 10.100000000000003");
  const CapturePlan plan = parse_plan(plan_with_views(text, {"fit_000", "heldout_000"}, "plan.toml"), "plan.toml");
  CapturePlan expected = parse_plan(text, "plan.toml");
  expected.views.erase(expected.views.begin() + 1);
  EXPECT_EQ(plan, expected);
  EXPECT_EQ(plan.views[0].turntable_deg, 10.100000000000003);
}

// As `[[views]]` as well as the inline array of the shipped plans.
TEST(ReducedPlan, TakesEitherFormOfTheViews) {
  std::string text = small_plan_toml();
  text.erase(text.find("views = ["), text.find("]\n\n[exposures]") + 1 - text.find("views = ["));
  for (const char* name : {"a", "b"}) {
    text += std::string("\n[[views]]\nname = \"") + name +
            "\"\nsplit = \"fit\"\nturntable_deg = 1\nlight_azimuth_deg = 2\nlight_elevation_deg = 3\n";
  }
  const CapturePlan plan = parse_plan(plan_with_views(text, {"b"}, "plan.toml"), "plan.toml");
  ASSERT_EQ(plan.views.size(), 1u);
  EXPECT_EQ(plan.views[0].name, "b");
  EXPECT_EQ(plan.bracket_exposures_s, small_plan().bracket_exposures_s);
}

}  // namespace
}  // namespace lumitexel
