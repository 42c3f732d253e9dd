#include "processing/fit/thinned_session.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "tests/unit/bad_input_matcher.h"
#include "tests/unit/plain_models.h"

namespace lumitexel {
namespace {

// Two lamps that take turns while the camera goes round in `turns` steps; held-out views in between and at the end.
CalibratedSession two_lamps(int turns) {
  CalibratedSession session;
  session.mesh = square_mesh();
  for (int i = 0; i < 2 * turns; ++i) {
    View view = view_from_above(4, 5.0);
    view.name = "fit_" + std::to_string(i);
    const Eigen::AngleAxisd turn(2.0 * M_PI * (i / 2) / turns, Eigen::Vector3d::UnitZ());
    view.camera_from_world = view_from_above(4, 5.0).camera_from_world *
                             Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitX()) * turn.inverse();
    view.light.vector_in_world = Eigen::Vector3d(i % 2 == 0 ? 0.6 : -0.6, 0.0, 0.8);
    session.views.push_back(view);
    if (i != turns) continue;
    view.name = "heldout_a";
    view.heldout = true;
    session.views.push_back(view);
  }
  session.views.push_back(session.views.front());
  session.views.back().name = "heldout_b";
  session.views.back().heldout = true;
  return session;
}

std::vector<std::string> names(const CalibratedSession& session) {
  std::vector<std::string> result;
  for (const View& view : session.views) result.push_back(view.name);
  return result;
}

TEST(ThinnedSession, KeepsSoManyFitViewsAllHeldOutOnesAndTheOrder) {
  const CalibratedSession session = two_lamps(8);
  ASSERT_EQ(fit_views(session), 16u);
  for (const std::size_t kept : {1u, 5u, 8u, 12u}) {
    const CalibratedSession thinned = with_fit_views(session, kept);
    EXPECT_EQ(fit_views(thinned), kept);
    EXPECT_EQ(heldout_views(thinned), 2u);
    std::vector<std::string> in_order;
    for (const std::string& name : names(session)) {
      if (testing::Value(names(thinned), testing::Contains(name))) in_order.push_back(name);
    }
    EXPECT_EQ(names(thinned), in_order);
  }
  EXPECT_EQ(names(with_fit_views(session, 16)), names(session));
}

TEST(ThinnedSession, HalfTheViewsStillHaveBothLampsAndGoRound) {
  const CalibratedSession thinned = with_fit_views(two_lamps(8), 8);
  std::set<int> sides;
  double left = 0;
  for (const View& view : thinned.views) {
    if (view.heldout) continue;
    left += view.light.vector_in_world.x() < 0.0;
    const Eigen::Vector3d eye = view.camera_in_world();
    sides.insert(static_cast<int>(std::floor((std::atan2(eye.y(), eye.x()) + M_PI) / M_PI_2 - 1e-6)));
  }
  EXPECT_GE(left, 3.0);  // of eight; every second of the list would have none
  EXPECT_LE(left, 5.0);
  EXPECT_GE(sides.size(), 4u);  // quadrants
}

TEST(ThinnedSession, FewerViewsAreAmongMoreViews) {
  const CalibratedSession session = two_lamps(8);
  EXPECT_THAT(names(with_fit_views(session, 12)), testing::IsSupersetOf(names(with_fit_views(session, 8))));
}

TEST(ThinnedSession, ViewsAtOnePlaceAreStillCounted) {
  CalibratedSession session = two_lamps(4);
  for (View& view : session.views) {
    view.camera_from_world = session.views.front().camera_from_world;
    view.light = session.views.front().light;
  }
  EXPECT_EQ(fit_views(with_fit_views(session, 5)), 5u);
}

TEST(ThinnedSession, RefusesNoneAndMoreThanThereAre) {
  const CalibratedSession session = two_lamps(4);
  EXPECT_BAD_INPUT(with_fit_views(session, 0), "1 to 8");
  EXPECT_BAD_INPUT(with_fit_views(session, 9), "9", "1 to 8");
}

}  // namespace
}  // namespace lumitexel
