#include "processing/fit/coarser_session.h"

#include <gtest/gtest.h>

#include "processing/image/binned_radiance.h"
#include "tests/unit/plain_models.h"
#include "tests/unit/temporary_folder.h"

namespace lumitexel {
namespace {

RadianceImage ramp(int width, int height) {
  RadianceImage image{Image(width, height, 3), Image(width, height, 3, 4.0f), std::vector<std::uint8_t>(static_cast<std::size_t>(width * height))};
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) image.radiance.at(x, y, 1) = static_cast<float>(x + 10 * y);
  }
  return image;
}

TEST(BinnedRadiance, IsTheMeanWithLessVariance) {
  const RadianceImage image = binned(ramp(7, 4), 2);
  ASSERT_EQ(image.radiance.width, 3);  // the odd column fills no block
  ASSERT_EQ(image.radiance.height, 2);
  EXPECT_EQ(image.radiance.at(1, 1, 1), 27.5f);  // of 22, 23, 32, 33
  EXPECT_EQ(image.radiance.at(1, 1, 0), 0.0f);
  EXPECT_EQ(image.variance.at(1, 1, 1), 1.0f);
}

TEST(BinnedRadiance, OnePixelMakesABlockUnusableButOnlyAllMakeItDark) {
  RadianceImage image = ramp(4, 2);
  image.flags[1] = kPixelSaturated | kPixelDark;
  EXPECT_EQ(binned(image, 2).flag(0, 0), kPixelSaturated);
  for (const std::size_t i : {2u, 3u, 6u, 7u}) image.flags[i] = kPixelDark;
  EXPECT_EQ(binned(image, 2).flag(1, 0), kPixelDark);
}

TEST(CoarserSession, PointsLieInTheSamePlaceAndHeldOutViewsStay) {
  const TemporaryFolder folder;
  CalibratedSession session;
  session.mesh = square_mesh();
  session.views = {view_from_above(8, 5.0), view_from_above(8, 5.0)};
  session.views[1].heldout = true;
  for (View& view : session.views) view.photograph = folder.path() / "photograph.exr";
  const CameraModel& fine = session.views[0].camera;
  write_radiance_image(session.views[0].photograph, ramp(fine.width_px, fine.height_px));
  std::filesystem::path written;
  {
    const CoarserSession coarser(session, 2);
    const View& view = coarser.session().views[0];
    written = view.photograph;
    EXPECT_EQ(read_radiance_image(written).radiance.width, fine.width_px / 2);
    const Eigen::Vector3d point(0.1, -0.2, 3.0);
    EXPECT_LT((2.0 * view.camera.project(point) - fine.project(point)).norm(), 1e-12);
    EXPECT_EQ(coarser.session().views[1].photograph, session.views[1].photograph);
    EXPECT_EQ(coarser.session().views[1].camera.width_px, fine.width_px);
  }
  EXPECT_FALSE(std::filesystem::exists(written));
}

}  // namespace
}  // namespace lumitexel
