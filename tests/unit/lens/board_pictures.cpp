#include "tests/unit/lens/board_pictures.h"

#include <apriltag/apriltag.h>
#include <apriltag/tag36h11.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <random>

namespace lumitexel {
namespace {

constexpr double kWhite = 0.9, kBlack = 0.05;

double halton(int index, int base) {
  double result = 0, part = 1;
  for (int i = index; i > 0; i /= base) result += (part /= base) * (i % base);
  return result;
}

// Points of a pixel's square, spread by a Gaussian.
std::vector<Eigen::Vector2d> spread_points(double blur_px, int count) {
  std::vector<Eigen::Vector2d> points;
  for (int i = 1; i <= count; ++i) {
    const double radius = blur_px * std::sqrt(-2.0 * std::log(1.0 - halton(i, 5)));
    const double angle = 2.0 * std::numbers::pi * halton(i, 7);
    points.emplace_back(halton(i, 2) - 0.5 + radius * std::cos(angle), halton(i, 3) - 0.5 + radius * std::sin(angle));
  }
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const auto& p : points) mean += p / count;
  for (auto& p : points) p -= mean;
  return points;
}

// The board's plane seen through a pixel, linear about the pixel's centre.
struct PlaneView {
  Eigen::Matrix3d board_from_ray;
  explicit PlaneView(const Eigen::Isometry3d& pose) {
    Eigen::Matrix3d ray_from_board;
    ray_from_board << pose.linear().leftCols<2>(), pose.translation();
    board_from_ray = ray_from_board.inverse();
  }
  Eigen::Vector2d operator()(const CameraModel& camera, const Eigen::Vector2d& pixel) const {
    const Eigen::Vector3d ray = camera.unproject(pixel);
    return (board_from_ray * (ray / ray.z())).hnormalized();
  }
};

}  // namespace

Pattern checkerboard_pattern(const BoardDescription& board) {
  return [board](double x, double y) {
    const double c = x / board.pitch_m + 0.5 * (board.columns + 1), r = y / board.pitch_m + 0.5 * (board.rows + 1);
    if (c < 0 || r < 0 || c >= board.columns + 1 || r >= board.rows + 1) return kWhite;
    return ((static_cast<int>(c) + static_cast<int>(r)) & 1) ? kWhite : kBlack;
  };
}

Pattern tag_grid_pattern(const BoardDescription& board) {
  std::vector<std::vector<std::uint8_t>> bitmaps;  // 10 x 10, the upper row first
  apriltag_family_t* family = tag36h11_create();
  for (int i = 0; i < board.columns * board.rows; ++i) {
    image_u8_t* image = apriltag_to_image(family, board.first_tag_id + i);
    std::vector<std::uint8_t> bits;
    for (int y = 0; y < 10; ++y)
      bits.insert(bits.end(), image->buf + y * image->stride, image->buf + y * image->stride + 10);
    bitmaps.push_back(std::move(bits));
    std::free(image->buf);  // what image_u8_destroy does; Debian's library does not export it
    std::free(image);
  }
  tag36h11_destroy(family);
  return [board, bitmaps](double x, double y) {
    const double c = x / board.pitch_m + 0.5 * board.columns, r = y / board.pitch_m + 0.5 * board.rows;
    if (c < 0 || r < 0 || c >= board.columns || r >= board.rows) return kWhite;
    const double cell = board.tag_size_m / 8.0;
    const double u = 5.0 + (c - std::floor(c) - 0.5) * board.pitch_m / cell;
    const double v = 5.0 - (r - std::floor(r) - 0.5) * board.pitch_m / cell;  // downwards
    if (u < 0 || v < 0 || u >= 10 || v >= 10) return kWhite;
    const auto tag = static_cast<std::size_t>(static_cast<int>(r) * board.columns + static_cast<int>(c));
    return bitmaps[tag][static_cast<std::size_t>(static_cast<int>(v) * 10 + static_cast<int>(u))] > 127 ? kWhite
                                                                                                        : kBlack;
  };
}

std::vector<float> board_electrons(const CameraModel& camera, const Eigen::Isometry3d& pose, const Pattern& pattern,
                                   const PictureOptions& options) {
  const PlaneView plane(pose);
  const int w = camera.width_px, h = camera.height_px;
  const auto index = [w](int x, int y) {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(w) + static_cast<std::size_t>(x);
  };
  std::vector<Eigen::Vector2d> place(static_cast<std::size_t>(w) * static_cast<std::size_t>(h));
  std::vector<double> centre(place.size());
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      place[index(x, y)] = plane(camera, {x + 0.5, y + 0.5});
      centre[index(x, y)] = pattern(place[index(x, y)].x(), place[index(x, y)].y());
    }
  }
  const int reach = static_cast<int>(std::ceil(3.5 * options.blur_px + 0.5));
  // Every pixel takes another stretch of one low-discrepancy sequence: with the same points everywhere, an edge's steps
  // line up and its place is wrong by 0.005 px.
  constexpr std::size_t kPoints = 3'200, kAll = 60'000;
  const auto points = spread_points(options.blur_px, kAll);
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::size_t> first_point(0, kAll - kPoints);
  std::vector<float> electrons(place.size());
  for (int y = 0; y < h; ++y) {
    for (int x = 0; x < w; ++x) {
      double value = centre[index(x, y)];
      bool edge = false;
      for (int v = std::max(0, y - reach); v <= std::min(h - 1, y + reach) && !edge; ++v) {
        for (int u = std::max(0, x - reach); u <= std::min(w - 1, x + reach) && !edge; ++u)
          edge = centre[index(u, v)] != value;
      }
      if (edge) {
        const int x0 = std::clamp(x, 1, w - 2), y0 = std::clamp(y, 1, h - 2);
        const Eigen::Vector2d by_x = 0.5 * (place[index(x0 + 1, y)] - place[index(x0 - 1, y)]);
        const Eigen::Vector2d by_y = 0.5 * (place[index(x, y0 + 1)] - place[index(x, y0 - 1)]);
        value = 0;
        const std::size_t first = first_point(random);
        for (std::size_t k = first; k < first + kPoints; ++k) {
          const Eigen::Vector2d q = place[index(x, y)] + points[k].x() * by_x + points[k].y() * by_y;
          value += pattern(q.x(), q.y()) / kPoints;
        }
      }
      electrons[index(x, y)] =
          static_cast<float>(options.white_electrons * value * (1.0 + options.falloff * ((x + 0.5) / w - 0.5)));
    }
  }
  return electrons;
}

MosaicRadiance noisy_picture(const CameraModel& camera, const std::vector<float>& electrons,
                             const PictureOptions& options, std::uint64_t seed) {
  MosaicRadiance image{camera.width_px, camera.height_px, options.mosaic, electrons, electrons, {}, false, {}};
  image.flags.assign(electrons.size(), 0);
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  for (std::size_t i = 0; i < electrons.size(); ++i) {
    const double variance = electrons[i] + options.read_noise_e * options.read_noise_e;
    image.value[i] = static_cast<float>(electrons[i] + std::sqrt(variance) * normal(random));
    image.variance[i] = static_cast<float>(variance);
  }
  return image;
}

Eigen::Isometry3d board_pose(double distance_m, double tilt_x_deg, double tilt_y_deg, double turn_deg, double right_m,
                             double down_m) {
  const double degree = std::numbers::pi / 180.0;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(tilt_x_deg * degree, Eigen::Vector3d::UnitX()) *
                   Eigen::AngleAxisd(tilt_y_deg * degree, Eigen::Vector3d::UnitY()) *
                   Eigen::AngleAxisd(turn_deg * degree, Eigen::Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()))
                      .toRotationMatrix();
  pose.translation() << right_m, down_m, distance_m;
  return pose;
}

BoardSighting noisy_sighting(const CameraModel& camera, const BoardDescription& board, const Eigen::Isometry3d& pose,
                             double sigma_px, std::uint64_t seed, const std::string& name) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  BoardSighting sighting{name, {}};
  for (int r = 0; r < board.rows; ++r) {
    for (int c = 0; c < board.columns; ++c) {
      const Eigen::Vector3d x((c - 0.5 * (board.columns - 1)) * board.pitch_m,
                              (r - 0.5 * (board.rows - 1)) * board.pitch_m, 0);
      Eigen::Vector2d pixel = camera.project(pose * x);
      if (!camera.contains(pixel)) continue;
      pixel.x() += sigma_px * normal(random);
      pixel.y() += sigma_px * normal(random);
      sighting.landmarks.push_back({{x}, {pixel}, sigma_px * sigma_px * Eigen::Matrix2d::Identity()});
    }
  }
  return sighting;
}

}  // namespace lumitexel
