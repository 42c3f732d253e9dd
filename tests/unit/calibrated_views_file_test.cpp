#include "processing/calibration/calibrated_views_file.h"

#include <gtest/gtest.h>

#include <fstream>

#include "drivers/error.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

CalibratedSession one_view(const std::filesystem::path& folder) {
  CalibratedSession session;
  session.channels = 3;
  session.key = "abc";
  session.gray_card_scale_sigma = 0.001;
  View view;
  view.name = "fit_000";
  view.heldout = true;
  view.camera = {1024, 768, 2950.1, 2950.2, 516.3, 379.8, -0.08, 0.15, 0.0004, -0.0003};
  view.camera_from_world =
      Eigen::Translation3d(0.1, 0.2, 0.3) * Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 3).normalized());
  view.light = {Light::Type::Point, {0.1, 1.0 / 3.0, 0.7}, {1e5, 2e5, 3e5}, 0.0007};
  view.light.radius_m = 0.05;
  view.photograph = folder / "fit_000.exr";
  session.views.push_back(view);
  return session;
}

TEST(CalibratedViewsFile, RoundTripsExactly) {
  const TemporaryFolder folder;
  const CalibratedSession written = one_view(folder.path());
  std::ofstream(written.views[0].photograph) << "x";
  CalibrationSummary summary;
  summary.lights.push_back({"fit_000", {1, 2, 3}, 0.1, true, 6, 1, 0.02, {4, 5, 6}, 0.2, true});
  summary.intensity = {1, 2, 3};
  summary.lamp.radius_m = 0.05;
  summary.lamp.radius_source = "highlights";
  summary.lamp.highlights_radius_m = 0.051;
  summary.lamp.highlights_radius_sigma_m = 0.002;
  summary.stray_lights.push_back({{"fit_000"}, false, {0.6, 0.0, 0.8}, 0.0, 0.69, 0.02, false});
  summary.hot_pixels = 5;
  write_calibrated_views(folder.path(), written, summary);
  const auto read = read_calibrated_views(folder.path());
  ASSERT_TRUE(read);
  const View& view = read->first.views.at(0);
  EXPECT_EQ(view.name, "fit_000");
  EXPECT_TRUE(view.heldout);
  EXPECT_EQ(view.camera_from_world.matrix(), written.views[0].camera_from_world.matrix());
  EXPECT_EQ(view.light.vector_in_world, written.views[0].light.vector_in_world);
  EXPECT_EQ(view.light.intensity, written.views[0].light.intensity);
  EXPECT_EQ(view.light.radius_m, 0.05);
  EXPECT_EQ(view.camera.p2, -0.0003);
  EXPECT_EQ(view.photograph, written.views[0].photograph);
  EXPECT_EQ(read->first.gray_card_scale_sigma, 0.001);
  EXPECT_EQ(read->second.lights.at(0).spheres_alone_in_world, Eigen::Vector3d(4, 5, 6));
  EXPECT_TRUE(read->second.lights.at(0).off_the_arm);
  EXPECT_EQ(read->second.hot_pixels, 5);
  EXPECT_EQ(read->second.lamp.radius_m, 0.05);
  EXPECT_EQ(read->second.lamp.radius_source, "highlights");
  EXPECT_EQ(read->second.lamp.highlights_radius_m, 0.051);
  EXPECT_EQ(read->second.lamp.highlights_radius_sigma_m, 0.002);
  EXPECT_FALSE(read->second.lamp.highlights_radius_bound_m);
  const StrayLightSummary& stray = read->second.stray_lights.at(0);
  EXPECT_FALSE(stray.placed);
  EXPECT_EQ(stray.position_in_rig, Eigen::Vector3d(0.6, 0.0, 0.8));
  EXPECT_EQ(stray.card_share, 0.69);
  EXPECT_FALSE(stray.counted_in_scale);
  EXPECT_EQ(stray.card_share_sigma, 0.02);
}

TEST(CalibratedViewsFile, IsNotThereUntilEverythingIs) {
  const TemporaryFolder folder;
  EXPECT_FALSE(read_calibrated_views(folder.path()));
  write_calibrated_views(folder.path(), one_view(folder.path()), {});
  EXPECT_FALSE(read_calibrated_views(folder.path()));  // the photograph is missing
}

TEST(CalibratedViewsFile, ADamagedOneIsMadeAgain) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "views.json") << "{\"version\": 1, ";
  EXPECT_FALSE(read_calibrated_views(folder.path()).has_value());
}

}  // namespace
}  // namespace lumitexel
