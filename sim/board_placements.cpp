#include "sim/board_placements.h"

#include <cmath>
#include <numbers>

#include "sim/printed_pattern.h"
#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

constexpr std::uint64_t kPlacementStream = 500;
constexpr int kPartlyOut = 6;  // every so many placements
constexpr double kEdge_px = 4.0;

double radians(double deg) { return deg * std::numbers::pi / 180.0; }
double fraction(double value) { return value - std::floor(value); }

// Printed side to the camera, rows level.
Eigen::Matrix3d facing() { return Eigen::Vector3d(1.0, -1.0, -1.0).asDiagonal(); }

bool in_picture(const CameraModel& camera, const Eigen::Isometry3d& camera_from_board, const Eigen::Vector2d& half_m) {
  for (const double sx : {-1.0, 1.0}) {
    for (const double sy : {-1.0, 1.0}) {
      const Eigen::Vector2d pixel = camera.project(camera_from_board * Eigen::Vector3d(sx * half_m.x(), sy * half_m.y(), 0.0));
      if (!(pixel.x() > kEdge_px && pixel.y() > kEdge_px && pixel.x() < camera.width_px - kEdge_px &&
            pixel.y() < camera.height_px - kEdge_px)) {
        return false;
      }
    }
  }
  return true;
}

// Towards the picture's middle until the board is wholly in it, or stands there.
void move_into_picture(const CameraModel& camera, const Eigen::Vector2d& half_m, Eigen::Isometry3d& camera_from_board) {
  constexpr int kSteps = 40;
  const Eigen::Vector3d middle(0.0, 0.0, camera_from_board.translation().z());
  const Eigen::Vector3d wanted = camera_from_board.translation();
  for (int step = 0; step <= kSteps; ++step) {
    camera_from_board.translation() = middle + (1.0 - static_cast<double>(step) / kSteps) * (wanted - middle);
    if (in_picture(camera, camera_from_board, half_m)) return;
  }
}

Eigen::Isometry3d spread_pose(const SimulatedWorld& world, int placement, double distance_m) {
  CounterRandom random(extended_key(world.settings.seed, kPlacementStream), static_cast<std::uint64_t>(placement));
  // Additive recurrences fill ranges evenly from the first placements on.
  const double n = placement - 2;
  const double along = distance_m * (0.7 + 0.4 * fraction(0.35 + n * 0.6180339887));
  const double tilt = radians(10.0 + 25.0 * fraction(0.9 + n * 0.7548776662));
  const double tilt_towards = 2.0 * std::numbers::pi * fraction(0.1 + n * 0.3819660113) + 0.4 * (random.uniform() - 0.5);
  const double roll = radians(30.0 * (random.uniform() - 0.5));
  const int cell = placement % 9;
  const Eigen::Vector2d share(0.5 + (cell % 3 - 1) * 0.3 + 0.1 * (random.uniform() - 0.5),
                              0.5 + (cell / 3 - 1) * 0.3 + 0.1 * (random.uniform() - 0.5));
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
  if (placement % kPartlyOut != 0) {
    move_into_picture(world.camera, BoardPattern(*world.rig.board).half_size_m(), result.camera_from_board);
  }
  return result;
}

}  // namespace lumitexel
