#include "sim/board_placements.h"

#include <array>
#include <cmath>
#include <numbers>

#include "sim/printed_pattern.h"
#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

constexpr std::uint64_t kPlacementStream = 500;
constexpr double kEdge_px = 4.0;

double radians(double deg) { return deg * std::numbers::pi / 180.0; }
double fraction(double value) { return value - std::floor(value); }

// Printed side to the camera, rows level.
Eigen::Matrix3d facing() { return Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal(); }

// Half of what has to be in the picture: all squares and a third of the white margin, which is as wide as a square. A board held
// farther into the corner is not found, one held less far leaves the corner empty.
Eigen::Vector2d needed_half_m(const BoardDescription& board) {
  constexpr double kMarginNeeded = 1.0 / 3.0;
  const Eigen::Vector2d half_m = BoardPattern(board).half_size_m();
  if (board.pattern != BoardDescription::Pattern::Checkerboard) return half_m;
  return half_m.array() - (1.0 - kMarginNeeded) * board.pitch_m;
}

Eigen::AlignedBox2d extent_in_picture(const CameraModel& camera, const Eigen::Isometry3d& camera_from_board,
                                      const Eigen::Vector2d& half_m) {
  Eigen::AlignedBox2d box;
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0})
      box.extend(camera.project(camera_from_board * Eigen::Vector3d(sx * half_m.x(), sy * half_m.y(), 0.0)));
  }
  return box;
}

// Along each axis of the picture as far as it takes for the board to be wholly in it; farther away if it is too large.
void move_into_picture(const CameraModel& camera, const Eigen::Vector2d& half_m, Eigen::Isometry3d& camera_from_board) {
  constexpr int kMostSteps = 60;
  constexpr double kFarther = 1.03, kClose_px = 0.5;
  const Eigen::Array2d least = Eigen::Array2d::Constant(kEdge_px),
                       most = Eigen::Array2d(camera.width_px, camera.height_px) - kEdge_px;
  const Eigen::Array2d focal(camera.focal_x_px, camera.focal_y_px);
  for (int step = 0; step < kMostSteps; ++step) {
    const Eigen::AlignedBox2d box = extent_in_picture(camera, camera_from_board, half_m);
    if (box.sizes().x() > most.x() - least.x() || box.sizes().y() > most.y() - least.y()) {
      camera_from_board.translation() *= kFarther;
      continue;
    }
    const Eigen::Array2d over = (least - box.min().array()).max(0.0) - (box.max().array() - most).max(0.0);
    if (over.abs().maxCoeff() < kClose_px) return;
    camera_from_board.translation().head<2>().array() += over / focal * camera_from_board.translation().z();
  }
}

// The corners first, where distortion is largest, then the middle and the edges; -1, 0, 1 across and down.
constexpr std::array<std::array<int, 2>, 9> kPlaces{
    {{-1, -1}, {1, 1}, {1, -1}, {-1, 1}, {0, 0}, {-1, 0}, {1, 0}, {0, -1}, {0, 1}}};

Eigen::Isometry3d spread_pose(const SimulatedWorld& world, int placement, double distance_m) {
  CounterRandom random(extended_key(world.settings.seed, kPlacementStream), static_cast<std::uint64_t>(placement));
  // Additive recurrences fill ranges evenly from the first placements on.
  const double n = placement - 2;
  const double along = distance_m * (0.7 + 0.4 * fraction(0.35 + n * 0.6180339887));
  const double tilt = radians(10.0 + 25.0 * fraction(0.9 + n * 0.7548776662));
  const double tilt_towards = 2.0 * std::numbers::pi * fraction(0.1 + n * 0.3819660113) + 0.4 * (random.uniform() - 0.5);
  const auto [across, down] = kPlaces[static_cast<std::size_t>(placement - 2) % kPlaces.size()];
  // Level in a corner, or one edge alone gets near it.
  const double roll = radians((across != 0 && down != 0 ? 10.0 : 30.0) * (random.uniform() - 0.5));
  const Eigen::Vector2d share(0.5 + 0.5 * across + 0.1 * (random.uniform() - 0.5), 0.5 + 0.5 * down + 0.1 * (random.uniform() - 0.5));
  const CameraModel& camera = world.camera;
  const Eigen::Vector3d ray = camera.unproject({share.x() * camera.width_px, share.y() * camera.height_px});
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.translation() = ray * (along / ray.z());
  const Eigen::Vector3d tilt_axis(std::cos(tilt_towards), std::sin(tilt_towards), 0.0);
  pose.linear() = Eigen::AngleAxisd(tilt, tilt_axis).toRotationMatrix() *
                  Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitZ()).toRotationMatrix() * facing();
  return pose;
}

// The third, the fifth and so on, as many as there are to be.
bool is_bent(const SimulationSettings& settings, int placement) {
  return placement >= 3 && placement % 2 == 1 && (placement - 3) / 2 < settings.board_outlier_placements;
}

}  // namespace

BoardPlacement board_placement(const SimulatedWorld& world, int placement) {
  const Eigen::Vector3d& pivot = world.rig.light_positioner.pivot_in_rig;
  const double distance_m = (world.rig.camera.camera_from_rig * pivot).norm();
  BoardPlacement result;
  if (is_bent(world.settings, placement)) result.bow_m = world.settings.board_bow_m;
  if (placement == 1) {
    result.camera_from_board.linear() = facing();
    result.camera_from_board.translation() = Eigen::Vector3d(0.0, 0.0, distance_m);
    return result;
  }
  result.camera_from_board = spread_pose(world, placement, distance_m);
  move_into_picture(world.camera, needed_half_m(*world.rig.board), result.camera_from_board);
  return result;
}

}  // namespace lumitexel
