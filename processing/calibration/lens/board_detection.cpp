#include "processing/calibration/lens/board_detection.h"

#include <Eigen/LU>
#include <map>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "drivers/error.h"
#include "processing/calibration/lens/checkerboard_corners.h"
#include "processing/calibration/lens/tag_detection.h"
#include "processing/calibration/lens/visible_picture.h"

namespace lumitexel {
namespace {

using Grid = std::vector<Eigen::Vector2d>;  // row by row

// Three searches, the quickest first: each finds boards that the others miss. All end in our own measurement of the corners,
// so how well a search places them does not matter.
bool find_pattern(const cv::Mat& picture, const cv::Size& corners, std::vector<cv::Point2f>& found) {
  constexpr int kHalfWindow_px = 4, kRounds = 30;
  constexpr double kStill_px = 0.01;
  if (cv::findChessboardCorners(picture, corners, found,
                                cv::CALIB_CB_ADAPTIVE_THRESH | cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_FAST_CHECK)) {
    cv::cornerSubPix(picture, found, {kHalfWindow_px, kHalfWindow_px}, {-1, -1},
                     {cv::TermCriteria::COUNT | cv::TermCriteria::EPS, kRounds, kStill_px});
    return true;
  }
  return cv::findChessboardCornersSB(picture, corners, found, cv::CALIB_CB_NORMALIZE_IMAGE) ||
         cv::findChessboardCornersSB(picture, corners, found, cv::CALIB_CB_NORMALIZE_IMAGE | cv::CALIB_CB_EXHAUSTIVE);
}

// OpenCV's corners in our pixels, rows and columns so that x runs right and y up when the board is seen from its front.
Grid find_corners(const MosaicRadiance& image, const BoardDescription& board) {
  GrayPicture picture = visible_picture(image);
  const cv::Mat whole(picture.height, picture.width, CV_8UC1, picture.data.data());
  constexpr int kWidest_px = 1600;
  const double scale = std::max(1.0, static_cast<double>(std::max(picture.width, picture.height)) / kWidest_px);
  cv::Mat small = whole;
  if (scale > 1.0) cv::resize(whole, small, {}, 1.0 / scale, 1.0 / scale, cv::INTER_AREA);
  std::vector<cv::Point2f> found;
  if (!find_pattern(small, {board.columns, board.rows}, found)) return {};
  Grid grid;
  // OpenCV has the centre of the top-left pixel at (0, 0).
  for (const cv::Point2f& p : found)
    grid.emplace_back((p.x + 0.5) * picture.width / small.cols, (p.y + 0.5) * picture.height / small.rows);
  const auto columns = static_cast<std::size_t>(board.columns);
  const Eigen::Vector2d right = grid[columns - 1] - grid[0], up = grid[grid.size() - columns] - grid[0];
  if (right.x() * up.y() - right.y() * up.x() > 0.0) {  // mirrored, y down: take the rows from the other end
    for (std::size_t r = 0; r < grid.size() / columns / 2; ++r) {
      std::swap_ranges(grid.begin() + static_cast<std::ptrdiff_t>(r * columns),
                       grid.begin() + static_cast<std::ptrdiff_t>((r + 1) * columns),
                       grid.end() - static_cast<std::ptrdiff_t>((r + 1) * columns));
    }
  }
  return grid;
}

void add_checkerboard(const MosaicRadiance& image, const BoardDescription& board, BoardSighting& sighting) {
  const Grid grid = find_corners(image, board);
  if (grid.empty()) return;
  const auto at = [&](int c, int r) { return grid[static_cast<std::size_t>(r * board.columns + c)]; };
  for (int r = 0; r < board.rows; ++r) {
    for (int c = 0; c < board.columns; ++c) {
      const int c0 = std::max(0, c - 1), c1 = std::min(board.columns - 1, c + 1);
      const int r0 = std::max(0, r - 1), r1 = std::min(board.rows - 1, r + 1);
      const auto corner = measure_checker_corner(image, at(c, r), (at(c1, r) - at(c0, r)) / (c1 - c0),
                                                 (at(c, r1) - at(c, r0)) / (r1 - r0));
      if (!corner) continue;
      const Eigen::Vector3d x((c - 0.5 * (board.columns - 1)) * board.pitch_m,
                              (r - 0.5 * (board.rows - 1)) * board.pitch_m, 0.0);
      sighting.landmarks.push_back({{x}, {corner->pixel}, corner->covariance_px2});
    }
  }
}

void add_tags(const MosaicRadiance& image, const BoardDescription& board, const std::optional<CameraModel>& lens,
              BoardSighting& sighting) {
  const std::vector<DetectedTag> tags = detect_tags(image, lens);
  std::map<int, int> times_seen;
  for (const DetectedTag& tag : tags) ++times_seen[tag.id];
  for (const DetectedTag& tag : tags) {
    const int place = tag.id - board.first_tag_id;
    if (place < 0 || place >= board.columns * board.rows || times_seen[tag.id] > 1) continue;
    const int c = place % board.columns, r = place / board.columns;
    TagDescription printed;
    printed.size_m = board.tag_size_m;
    printed.centre = {(c - 0.5 * (board.columns - 1)) * board.pitch_m, (r - 0.5 * (board.rows - 1)) * board.pitch_m,
                      0.0};
    const auto corners = printed.corners();
    sighting.landmarks.push_back(
        {{corners.begin(), corners.end()}, {tag.corners_px.begin(), tag.corners_px.end()}, tag.covariance_px2});
  }
}

}  // namespace

BoardSighting detect_board(const MosaicRadiance& image, const BoardDescription& board, const std::string& name,
                           const std::optional<CameraModel>& lens) {
  const bool checkered = board.pattern == BoardDescription::Pattern::Checkerboard;
  const int least = checkered ? 3 : 1;  // what OpenCV needs
  if (board.columns < least || board.rows < least || !(board.pitch_m > 0.0))
    throw BadInput("board",
                   std::to_string(board.columns) + " x " + std::to_string(board.rows) + ", pitch " +
                       std::to_string(board.pitch_m) + " m",
                   "at least 3 x 3 inner corners or 1 x 1 tags, pitch > 0");
  BoardSighting sighting{name, {}};
  if (checkered) {
    add_checkerboard(image, board, sighting);
  } else {
    add_tags(image, board, lens, sighting);
  }
  return sighting;
}

}  // namespace lumitexel
