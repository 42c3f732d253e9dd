#include "sim/board_picture.h"

#include <tbb/parallel_for.h>

#include <cmath>
#include <numbers>

#include "sim/board_placements.h"
#include "sim/point_lamp.h"
#include "sim/printed_pattern.h"

namespace lumitexel {
namespace {

constexpr double kNowhere_m = 1e9;  // a place that is on no board

class LitBoard {
 public:
  LitBoard(const SimulatedWorld& world, const WorldState& state)
      : pattern_(*world.rig.board), placement_(board_placement(world, state.board)),
        curvature_per_m_(placement_.bow_m / (pattern_.half_size_m().x() * pattern_.half_size_m().x())) {
    const Eigen::Isometry3d board_from_camera = placement_.camera_from_board.inverse();
    eye_ = board_from_camera.translation();
    turn_ = board_from_camera.linear();
    const Eigen::Isometry3d board_from_rig = board_from_camera * world.rig.camera.camera_from_rig;
    const auto add = [&](const std::vector<Emitter>& lamp) {
      for (const Emitter& emitter : lamp) emitters_.push_back(emitter.in(board_from_rig));
    };
    if (state.ring_flash) add(ring_flash_in_rig(world));
    if (state.point_light) add(point_lamp_in_rig(world, state.light_azimuth_deg, state.light_elevation_deg));
  }

  // Where a ray from the camera meets the board's surface z = curvature * x^2; kNowhere_m if it does not.
  Eigen::Vector2d place_along(const Eigen::Vector3d& direction_in_camera) const {
    const Eigen::Vector3d ray = turn_ * direction_in_camera;
    const double a = curvature_per_m_ * ray.x() * ray.x();
    const double b = 2.0 * curvature_per_m_ * eye_.x() * ray.x() - ray.z();
    const double c = curvature_per_m_ * eye_.x() * eye_.x() - eye_.z();
    const double discriminant = b * b - 4.0 * a * c;
    if (!(discriminant > 0.0)) return Eigen::Vector2d::Constant(kNowhere_m);
    const double along = -2.0 * c / (b + std::copysign(std::sqrt(discriminant), b));  // the root that a flat board has
    if (!(along > 0.0)) return Eigen::Vector2d::Constant(kNowhere_m);
    return (eye_ + along * ray).head<2>();
  }

  Eigen::Array3d irradiance_at(const Eigen::Vector2d& place) const {
    const Eigen::Vector3d point(place.x(), place.y(), curvature_per_m_ * place.x() * place.x());
    const Eigen::Vector3d normal = Eigen::Vector3d(-2.0 * curvature_per_m_ * place.x(), 0.0, 1.0).normalized();
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (const Emitter& emitter : emitters_) {
      const Eigen::Vector3d to_light = emitter.position - point;
      const double distance_sq = to_light.squaredNorm();
      const Eigen::Vector3d wi = to_light / std::sqrt(distance_sq);
      const double cosine = normal.dot(wi);
      if (cosine > 0.0) sum += emitter.intensity_along(-wi) * (cosine / distance_sq);
    }
    return sum;
  }

  // Mean over a pixel whose corners see these places: upper left, upper right, lower left, lower right.
  double mean_albedo(const std::array<Eigen::Vector2d, 4>& corner) const {
    constexpr int kSamples = 144, kStride = 89;  // a Fibonacci lattice: no two samples in one row or column, so that
                                                 // edges along the rows are as fine as any
    const auto at = [&](double u, double v) {
      return pattern_.albedo_at((1.0 - v) * ((1.0 - u) * corner[0] + u * corner[1]) +
                                v * ((1.0 - u) * corner[2] + u * corner[3]));
    };
    const double middle = at(0.5, 0.5);
    if (at(0, 0) == middle && at(1, 0) == middle && at(0, 1) == middle && at(1, 1) == middle) return middle;
    double sum = 0.0;
    for (int i = 0; i < kSamples; ++i) {
      sum += at((i + 0.5) / kSamples, (i * kStride % kSamples + 0.5) / kSamples);
    }
    return sum / kSamples;
  }

 private:
  BoardPattern pattern_;
  BoardPlacement placement_;
  double curvature_per_m_;
  Eigen::Vector3d eye_;  // and what follows: in the board's frame
  Eigen::Matrix3d turn_;
  std::vector<Emitter> emitters_;
};

}  // namespace

Image board_picture(const SimulatedWorld& world, const WorldState& state,
                    const std::vector<Eigen::Vector3d>& corner_directions) {
  const int width = world.camera.width_px, height = world.camera.height_px;
  Image image(width, height, 3);
  const LitBoard board(world, state);
  tbb::parallel_for(0, height, [&](int y) {
    const auto place_at = [&](int i, int j) {
      return board.place_along(
          corner_directions[static_cast<std::size_t>(j) * static_cast<std::size_t>(width + 1) + static_cast<std::size_t>(i)]);
    };
    std::array<Eigen::Vector2d, 4> corner{};
    corner[1] = place_at(0, y);
    corner[3] = place_at(0, y + 1);
    for (int x = 0; x < width; ++x) {
      corner = {corner[1], place_at(x + 1, y), corner[3], place_at(x + 1, y + 1)};
      const double albedo = board.mean_albedo(corner);
      if (albedo == 0.0) continue;
      const Eigen::Array3d radiance = board.irradiance_at(0.25 * (corner[0] + corner[1] + corner[2] + corner[3])) *
                                      (albedo / std::numbers::pi);
      for (int c = 0; c < 3; ++c) image.at(x, y, c) = static_cast<float>(radiance[c]);
    }
  });
  return image;
}

}  // namespace lumitexel
