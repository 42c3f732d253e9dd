#include "processing/calibration/light/white_patches.h"

#include <array>
#include <cmath>
#include <optional>

#include "processing/image/linear_sensor.h"

namespace lumitexel {
namespace {

constexpr double kMiddle = 0.5;   // share of a square's edge that is averaged over: blur stays outside
constexpr int kFewestPixels = 4;

bool counts(const MosaicRadiance& image, int x, int y) {
  if (image.flags[image.index(x, y)] & kUnusablePixel) return false;
  return image.mosaic == Mosaic::Mono || mosaic_channel(image.mosaic, x, y) == 1;
}

// The mean over the pixels whose centres project into the middle of the square about `centre`.
std::optional<WhitePatch> patch_at(const MosaicRadiance& image, const CameraModel& camera,
                                   const Eigen::Isometry3d& camera_from_board, const Eigen::Vector2d& centre,
                                   double half_m) {
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9), high = -low;
  for (const double u : {-1.0, 1.0}) {
    for (const double v : {-1.0, 1.0}) {
      const Eigen::Vector3d corner = camera_from_board * Eigen::Vector3d(centre.x() + u * half_m, centre.y() + v * half_m, 0.0);
      if (corner.z() <= 0.0) return std::nullopt;
      const Eigen::Vector2d pixel = camera.project(corner);
      if (!camera.contains(pixel)) return std::nullopt;
      low = low.min(pixel.array());
      high = high.max(pixel.array());
    }
  }
  const Eigen::Isometry3d board_from_camera = camera_from_board.inverse();
  const Eigen::Vector3d eye = board_from_camera.translation();
  double sum = 0.0, variances = 0.0;
  Eigen::Vector2d places = Eigen::Vector2d::Zero();
  int pixels = 0;
  for (int y = static_cast<int>(low.y()); y <= static_cast<int>(high.y()); ++y) {
    for (int x = static_cast<int>(low.x()); x <= static_cast<int>(high.x()); ++x) {
      if (!counts(image, x, y)) continue;
      const Eigen::Vector3d ray = board_from_camera.linear() * camera.unproject({x + 0.5, y + 0.5});
      const Eigen::Vector2d place = (eye - eye.z() / ray.z() * ray).head<2>();
      if (((place - centre).array().abs() > half_m).any()) continue;
      sum += image.value[image.index(x, y)];
      variances += image.variance[image.index(x, y)];
      places += place;
      ++pixels;
    }
  }
  if (pixels < kFewestPixels || !(sum > 0.0)) return std::nullopt;
  places /= pixels;
  return WhitePatch{camera_from_board * Eigen::Vector3d(places.x(), places.y(), 0.0), camera_from_board.linear().col(2),
                    sum / pixels, variances / pixels / pixels};
}

}  // namespace

std::vector<WhitePatch> white_patches(const MosaicRadiance& image, const CameraModel& camera,
                                      const Eigen::Isometry3d& camera_from_board, const BoardDescription& board) {
  if (board.pattern != BoardDescription::Pattern::Checkerboard) return {};
  std::array<std::vector<WhitePatch>, 2> colours;
  std::array<double, 2> sums{};
  // Squares between inner corners: one fewer than corners along each side, and one more beyond each end.
  for (int row = 0; row <= board.rows; ++row) {
    for (int column = 0; column <= board.columns; ++column) {
      const Eigen::Vector2d centre =
          board.pitch_m * Eigen::Vector2d(column - 0.5 * board.columns, row - 0.5 * board.rows);
      const auto patch = patch_at(image, camera, camera_from_board, centre, 0.5 * kMiddle * board.pitch_m);
      const auto colour = static_cast<std::size_t>((row + column) % 2);
      if (!patch) continue;
      colours[colour].push_back(*patch);
      sums[colour] += patch->radiance;
    }
  }
  const auto mean = [&](std::size_t c) { return colours[c].empty() ? 0.0 : sums[c] / static_cast<double>(colours[c].size()); };
  return mean(0) > mean(1) ? colours[0] : colours[1];
}

}  // namespace lumitexel
