#include "processing/calibration/import/imported_poses.h"

#include <gtest/gtest.h>

#include "processing/calibration/pose/centred_pose.h"
#include "tests/unit/pose/masked_views.h"

namespace lumitexel {
namespace {

// Six views with masks, all poses exact.
struct Imported {
  CalibratedSession session;
  std::vector<std::optional<ObjectPixels>> masks;
  CalibrationSummary summary;

  Imported() {
    session.mesh = unsymmetric_lump();
    const MaskedViews exact = masked_views(session.mesh, 6, 1);
    for (const MaskedView& seen : exact.views) {
      View& view = session.views.emplace_back();
      view.name = std::to_string(session.views.size());
      view.camera = exact.camera;
      view.camera_from_world = seen.camera_from_mesh;
      masks.push_back(ObjectPixels{exact.camera.width_px, exact.camera.height_px, seen.inside});
    }
  }
  void check(const CalibrationOptions& options = {}) {
    NoProgress quiet;
    check_given_poses(session, masks, options, summary, quiet);
  }
};

TEST(ImportedPoses, ReplacesTheOneThatItsMaskContradictsAndConfirmsTheOthers) {
  Imported imported;
  const Eigen::Isometry3d exact = imported.session.views[2].camera_from_world;
  imported.session.views[2].camera_from_world = Eigen::Translation3d(2e-3, 0, 0) * exact;
  const std::vector<View> given = imported.session.views;
  imported.check();
  ASSERT_EQ(imported.summary.pose_problem, "");
  for (std::size_t v = 0; v < 6; ++v) {
    const PoseSummary& pose = imported.summary.poses[v];
    EXPECT_EQ(pose.source, v == 2 ? "silhouette" : "given, confirmed by the silhouette") << v;
    EXPECT_TRUE(pose.sigma_m && pose.sigma_deg && pose.silhouette_px && pose.given_px && pose.contradiction);
    EXPECT_EQ(imported.session.views[v].camera_from_world.matrix() == given[v].camera_from_world.matrix(), v != 2) << v;
  }
  EXPECT_LT(*imported.summary.poses[2].silhouette_px, *imported.summary.poses[2].given_px);
  // Across the view it is seen to some hundredths of a pixel, 0.5 mm each.
  const Eigen::Vector3d centre = extent_of(imported.session.mesh).centre;
  EXPECT_LT((imported.session.views[2].camera_from_world * centre - exact * centre).head<2>().norm(), 2e-4);
  double shares = 0.0;
  for (const UncertaintyShare& share : imported.summary.shares) shares += share.share;
  EXPECT_NEAR(shares, 1.0, 1e-9);
}

TEST(ImportedPoses, StayWithoutMasksAndSayWhy) {
  Imported imported;
  imported.masks.assign(6, std::nullopt);
  imported.session.views[2].camera_from_world = Eigen::Translation3d(2e-3, 0, 0) * imported.session.views[2].camera_from_world;
  const Eigen::Matrix4d given = imported.session.views[2].camera_from_world.matrix();
  imported.check();
  EXPECT_EQ(imported.session.views[2].camera_from_world.matrix(), given);
  EXPECT_EQ(imported.summary.poses[2].source, "given");
  EXPECT_FALSE(imported.summary.poses[2].sigma_m);
  EXPECT_NE(imported.summary.pose_problem.find("no masks"), std::string::npos);
}

TEST(ImportedPoses, StayWhenTheStepIsLeftOut) {
  Imported imported;
  imported.check({{CalibrationStep::Pose}});
  for (const PoseSummary& pose : imported.summary.poses) EXPECT_EQ(pose.source, "given");
}

TEST(ImportedPoses, AMaskWithoutRimLeavesItsViewAlone) {
  Imported imported;
  std::fill(imported.masks[1]->inside.begin(), imported.masks[1]->inside.end(), std::uint8_t{1});
  imported.check();
  EXPECT_EQ(imported.summary.poses[1].source, "given");
  EXPECT_NE(imported.summary.poses[1].problem.find("rim"), std::string::npos);
  EXPECT_EQ(imported.summary.poses[0].source, "given, confirmed by the silhouette")
      << imported.summary.pose_problem << imported.summary.poses[0].problem;
}

}  // namespace
}  // namespace lumitexel
