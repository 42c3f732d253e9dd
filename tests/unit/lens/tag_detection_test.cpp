#include "processing/calibration/lens/tag_detection.h"

#include <gtest/gtest.h>

#include "tests/unit/lens/board_pictures.h"

namespace lumitexel {
namespace {

BoardDescription one_tag(double size_m, int id) {
  BoardDescription board;
  board.pattern = BoardDescription::Pattern::TagGrid;
  board.columns = board.rows = 1;
  board.pitch_m = 1.4 * size_m;
  board.tag_size_m = size_m;
  board.first_tag_id = id;
  return board;
}

std::array<Eigen::Vector2d, 4> true_corners(const CameraModel& camera, const Eigen::Isometry3d& pose, double size_m) {
  TagDescription tag;
  tag.size_m = size_m;
  const auto corners = tag.corners();
  std::array<Eigen::Vector2d, 4> pixels;
  for (std::size_t i = 0; i < 4; ++i) pixels[i] = camera.project(pose * corners[i]);
  return pixels;
}

CameraModel small_camera() { return {200, 160, 400.0, 400.0, 101.3, 79.2}; }

struct CornerErrors {
  double rms_px = 0, stated_px = 0, found_rms_px = 0;
  Eigen::Vector2d mean_px = Eigen::Vector2d::Zero();
  int found = 0;
};

// Tags of `edge_px`, turned and tilted differently for each seed.
CornerErrors corner_errors(double edge_px, int seeds, const PictureOptions& options) {
  const CameraModel camera = small_camera();
  CornerErrors errors;
  for (int seed = 0; seed < seeds; ++seed) {
    const double size_m = 0.05, distance_m = camera.focal_x_px * size_m / edge_px;
    const Eigen::Isometry3d pose =
        board_pose(distance_m, -20 + 40.0 * ((seed * 7) % 11) / 11, -20 + 40.0 * ((seed * 5) % 13) / 13, 37.0 * seed,
                   0.001 * (seed % 5), 0.0007 * (seed % 7));
    const auto electrons = board_electrons(camera, pose, tag_grid_pattern(one_tag(size_m, seed % 50)), options);
    const auto tags = detect_tags(noisy_picture(camera, electrons, options, static_cast<std::uint64_t>(seed)));
    if (tags.size() != 1 || tags[0].id != seed % 50) continue;
    const auto truth = true_corners(camera, pose, size_m);
    for (std::size_t c = 0; c < 4; ++c) {
      const Eigen::Vector2d miss = tags[0].corners_px[c] - truth[c];
      errors.rms_px += miss.squaredNorm();
      errors.mean_px += miss;
      errors.found_rms_px += (tags[0].found_px[c] - truth[c]).squaredNorm();
    }
    errors.stated_px += 8.0 * tags[0].sigma_px * tags[0].sigma_px;
    ++errors.found;
  }
  const double values = 8.0 * errors.found;
  errors.rms_px = std::sqrt(errors.rms_px / values);
  errors.found_rms_px = std::sqrt(errors.found_rms_px / values);
  errors.stated_px = std::sqrt(errors.stated_px / values);
  errors.mean_px /= 0.5 * values;
  return errors;
}

// Corner order and pixel centres: the tag's printed lower left corner comes first however the tag is turned. The
// tolerance is far below half a pixel, which is what a confusion of conventions costs, and far above the noise.
TEST(TagDetection, cornersComeInThePrintedOrderUnderAnyRotation) {
  const CameraModel camera = small_camera();
  for (int turn = 0; turn < 360; turn += 60) {
    const Eigen::Isometry3d pose = board_pose(0.4, 5, -8, turn);
    const auto tags = detect_tags(
        noisy_picture(camera, board_electrons(camera, pose, tag_grid_pattern(one_tag(0.05, 17)), {}), {}, 1));
    ASSERT_EQ(tags.size(), 1u) << turn;
    EXPECT_EQ(tags[0].id, 17);
    const auto truth = true_corners(camera, pose, 0.05);
    for (std::size_t c = 0; c < 4; ++c) EXPECT_LT((tags[0].corners_px[c] - truth[c]).norm(), 0.1) << turn << " " << c;
  }
}

// 0.75 … 1.3: the scatter of 128 correlated values of unequal sigmas is known to a tenth or so.
TEST(TagDetection, statedSigmaIsTheScatterAndBetterThanTheDetectorsOwn) {
  constexpr int kSeeds = 16;
  for (const double edge_px : {20.0, 30.0, 50.0, 100.0}) {
    const CornerErrors errors = corner_errors(edge_px, kSeeds, {});
    std::printf("tag %3.0f px: %d found, RMS %.4f, stated %.4f, libapriltag %.4f, mean %.4f %.4f\n", edge_px,
                errors.found, errors.rms_px, errors.stated_px, errors.found_rms_px, errors.mean_px.x(),
                errors.mean_px.y());
    EXPECT_GE(errors.found, kSeeds - 1);
    EXPECT_GT(errors.rms_px / errors.stated_px, 0.75);
    EXPECT_LT(errors.rms_px / errors.stated_px, 1.3);
    EXPECT_LT(errors.rms_px, 0.5 * errors.found_rms_px);
  }
}

TEST(TagDetection, readsGreenOfAMosaic) {
  PictureOptions options;
  options.mosaic = Mosaic::Rggb;
  const CornerErrors errors = corner_errors(50.0, 8, options);
  std::printf("mosaic: RMS %.4f stated %.4f\n", errors.rms_px, errors.stated_px);
  EXPECT_EQ(errors.found, 8);
  EXPECT_LT(errors.rms_px / errors.stated_px, 1.4);
}

TEST(TagDetection, aHighlightTenThousandTimesAsBrightDoesNotHideATag) {
  const CameraModel camera = small_camera();
  auto electrons = board_electrons(camera, board_pose(0.5, 5, 5, 10), tag_grid_pattern(one_tag(0.05, 3)), {});
  for (int y = 2; y < 12; ++y) {
    for (int x = 2; x < 20; ++x) electrons[static_cast<std::size_t>(y * 200 + x)] = 1e8f;
  }
  EXPECT_EQ(detect_tags(noisy_picture(camera, electrons, {}, 1)).size(), 1u);
}

TEST(TagDetection, blackAndSaturatedFramesHoldNoTags) {
  const CameraModel camera = small_camera();
  const std::vector<float> dark(200 * 160, 0.0f), bright(200 * 160, 30000.0f);
  EXPECT_TRUE(detect_tags(noisy_picture(camera, dark, {}, 1)).empty());
  MosaicRadiance saturated = noisy_picture(camera, bright, {}, 1);
  std::fill(saturated.flags.begin(), saturated.flags.end(), kPixelSaturated);
  EXPECT_TRUE(detect_tags(saturated).empty());
}

}  // namespace
}  // namespace lumitexel
