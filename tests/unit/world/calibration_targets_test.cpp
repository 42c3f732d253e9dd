// The pictures of board and tags against their truth, found by OpenCV and AprilTag as calibration will.
#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <memory>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "rig/rig_file.h"
#include "sim/board_placements.h"
#include "sim/printed_pattern.h"
#include "sim/render_radiance.h"
#include "sim/simulated_rig.h"

namespace lumitexel {
namespace {

std::string metrology_file() {
  return (std::filesystem::path(LUMITEXEL_SOURCE_DIR) / "config/rigs/simulated_metrology.toml").string();
}

const std::shared_ptr<SimulatedWorld>& metrology_world() {
  static const std::shared_ptr<SimulatedWorld> world = [] {
    const std::string file = metrology_file();
    return build_world(parse_rig(read_rig_file(file), file), file);
  }();
  return world;
}

cv::Mat gray(const Image& image, double white) {
  cv::Mat picture(image.height, image.width, CV_8U);
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      picture.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(255.0 * image.at(x, y, 1) / white);
    }
  }
  return picture;
}

// Root mean square distance of the found corners from the projected ones, in whichever of the two orders fits.
double corner_rms_px(RadianceRenderer& renderer, int placement) {
  const SimulatedWorld& world = renderer.world();
  const BoardDescription& board = *world.rig.board;
  cv::Mat picture = gray(*renderer.render({.ring_flash = true, .board = placement}), 2.5);
  // cornerSubPix wants edges wider than a pixel: on the box filter's, where they run along the rows, it is off by up to
  // 0.1 px (measured: 0.079 and 0.084 px rms on placements 1 and 5; 0.043 and 0.046 after this blur, 0.029 and 0.031 after 1.2).
  cv::GaussianBlur(picture, picture, {0, 0}, 0.8);
  std::vector<cv::Point2f> found;
  if (!cv::findChessboardCorners(picture, {board.columns, board.rows}, found)) return 1e9;
  cv::cornerSubPix(picture, found, {5, 5}, {-1, -1}, {cv::TermCriteria::EPS | cv::TermCriteria::COUNT, 50, 1e-4});
  const BoardPlacement placed = board_placement(world, placement);
  double best = 1e18;
  for (const bool reversed : {false, true}) {
    double sum = 0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      const int column = static_cast<int>(i) % board.columns, row = static_cast<int>(i) / board.columns;
      const Eigen::Vector3d corner(board.pitch_m * (column - 0.5 * (board.columns - 1)),
                                   board.pitch_m * (0.5 * (board.rows - 1) - row), 0.0);
      const Eigen::Vector2d expected = world.camera.project(placed.camera_from_board * corner);
      const cv::Point2f& at = found[reversed ? found.size() - 1 - i : i];
      sum += (expected - Eigen::Vector2d(at.x + 0.5, at.y + 0.5)).squaredNorm();  // OpenCV's pixel centres are whole
    }
    best = std::min(best, sum / static_cast<double>(found.size()));
  }
  return std::sqrt(best);
}

// OpenCV's detector itself is good to some hundredths of a pixel on clean pictures.
constexpr double kDetector_px = 0.06;

TEST(CalibrationTargets, BoardCornersLieWhereTheTruthSays) {
  RadianceRenderer renderer(metrology_world());
  for (const int placement : {1, 2, 4, 5}) EXPECT_LT(corner_rms_px(renderer, placement), kDetector_px) << placement;
}

TEST(CalibrationTargets, ABentBoardIsOffTheFlatOnesTruth) {
  const SimulatedWorld& world = *metrology_world();
  SimulationSettings settings = world.settings;
  const std::string file = metrology_file();
  settings.board_outlier_placements = 1;
  settings.board_bow_m = 0.006;
  const SimulatedWorld bent(parse_rig(read_rig_file(file), file), settings, file);
  EXPECT_EQ(board_placement(bent, 3).bow_m, 0.006);
  EXPECT_EQ(board_placement(bent, 2).bow_m, 0.0);
  EXPECT_EQ(board_placement(bent, 5).bow_m, 0.0);
  // The metrology world's own placements are flat; this one shows the same pose with the bow.
  RadianceRenderer flat_renderer(metrology_world());
  RadianceRenderer bent_renderer(std::make_shared<SimulatedWorld>(parse_rig(read_rig_file(file), file), settings, file));
  std::vector<cv::Point2f> flat, bowed;
  const cv::Size size(world.rig.board->columns, world.rig.board->rows);
  ASSERT_TRUE(cv::findChessboardCorners(gray(*flat_renderer.render({.ring_flash = true, .board = 3}), 2.5), size, flat));
  ASSERT_TRUE(cv::findChessboardCorners(gray(*bent_renderer.render({.ring_flash = true, .board = 3}), 2.5), size, bowed));
  double largest = 0;
  for (std::size_t i = 0; i < flat.size(); ++i) largest = std::max(largest, cv::norm(flat[i] - bowed[i]));
  EXPECT_GT(largest, 1.0);  // far beyond any detector's noise
}

// Every square of every board in the picture, and corners of squares near all of the picture's own after five placements.
TEST(CalibrationTargets, PlacementsAreWholeAndReachThePicturesCorners) {
  const SimulatedWorld& world = *metrology_world();
  const BoardDescription& board = *world.rig.board;
  const Eigen::Vector2d inner = 0.5 * board.pitch_m * Eigen::Vector2d(board.columns - 1, board.rows - 1);
  std::array<double, 4> nearest;
  nearest.fill(1e9);
  for (int placement = 1; placement <= 16; ++placement) {
    const Eigen::Isometry3d pose = board_placement(world, placement).camera_from_board;
    EXPECT_LE(std::acos(-pose.linear()(2, 2)) * 180 / M_PI, 35.0 + 1e-9);
    EXPECT_GT(pose.translation().z(), 0.69);
    EXPECT_LT(pose.translation().z(), 1.2);
    for (const double sx : {-1.0, 1.0}) {
      for (const double sy : {-1.0, 1.0}) {
        const Eigen::Vector2d outer = inner.array() + board.pitch_m;
        EXPECT_TRUE(world.camera.contains(world.camera.project(pose * Eigen::Vector3d(sx * outer.x(), sy * outer.y(), 0)))) << placement;
        const Eigen::Vector2d corner = world.camera.project(pose * Eigen::Vector3d(sx * inner.x(), sy * inner.y(), 0));
        for (std::size_t k = 0; k < 4 && placement <= 5; ++k)
          nearest[k] = std::min(nearest[k], (corner - Eigen::Vector2d(k % 2 * 1024.0, static_cast<double>(k / 2) * 768.0)).norm());
      }
    }
  }
  // A square and a third is 50 to 75 pixels there, along both axes, and tilted boards touch an edge with one corner.
  for (const double distance_px : nearest) EXPECT_LT(distance_px, 150.0);
}

TEST(CalibrationTargets, TagsAreReadWhereTheTruthSays) {
  const SimulatedWorld& world = *metrology_world();
  RadianceRenderer renderer(metrology_world());
  const double turn_deg = 60;
  cv::Mat picture = gray(*renderer.render({.turntable_deg = turn_deg, .light_elevation_deg = 50, .point_light = true}), 2.0);
  const std::unique_ptr<apriltag_family_t, void (*)(apriltag_family_t*)> family(tag36h11_create(), tag36h11_destroy);
  const std::unique_ptr<apriltag_detector_t, void (*)(apriltag_detector_t*)> detector(apriltag_detector_create(),
                                                                                       apriltag_detector_destroy);
  apriltag_detector_add_family(detector.get(), family.get());
  detector->quad_decimate = 1;
  image_u8_t view{picture.cols, picture.rows, static_cast<int>(picture.step), picture.data};
  const std::unique_ptr<zarray_t, void (*)(zarray_t*)> found(apriltag_detector_detect(detector.get(), &view),
                                                             apriltag_detections_destroy);
  int on_table = 0, on_card = 0;
  for (int i = 0; i < zarray_size(found.get()); ++i) {
    apriltag_detection_t* detection = nullptr;
    zarray_get(found.get(), i, &detection);
    for (const TagDescription& tag : world.rig.tags) {
      if (tag.id != detection->id) continue;
      (tag.on_table ? on_table : on_card) += 1;
      const std::array<Eigen::Vector3d, 4> corners = tag.corners();
      for (std::size_t k = 0; k < 4; ++k) {  // in the printed order, which AprilTag's is: lower left first
        const Eigen::Vector3d in_rig = tag.on_table ? world.rig.turntable.rig_from_table(turn_deg) * corners[k] : corners[k];
        const Eigen::Vector2d pixel = world.camera.project(world.rig.camera.camera_from_rig * in_rig);
        // AprilTag on tags of 20 to 45 px; a wrong order would be off by a whole edge.
        EXPECT_LT((pixel - Eigen::Vector2d(detection->p[k][0], detection->p[k][1])).norm(), 0.5) << tag.id << " " << k;
      }
    }
  }
  EXPECT_GE(on_table, 4);
  EXPECT_GE(on_card, 3);
}

// Ink that lets the backlight through: the silhouettes are those of a bench without tags.
TEST(CalibrationTargets, ClearTagsLeaveSilhouettesAlone) {
  const SimulatedWorld& world = *metrology_world();
  SimulationSettings settings = world.settings;
  const std::string file = metrology_file();
  const auto silhouette = [&](const RigDescription& rig) {
    return RadianceRenderer(std::make_shared<SimulatedWorld>(rig, settings, file)).render({.backlight = true})->data;
  };
  RigDescription rig = parse_rig(read_rig_file(file), file), bare = rig;
  bare.tags.clear();
  settings.samples_per_pixel = 1;
  EXPECT_TRUE(silhouette(rig) == silhouette(bare));
  settings.tags_clear_to_backlight = false;
  EXPECT_FALSE(silhouette(rig) == silhouette(bare));
}

}  // namespace
}  // namespace lumitexel
