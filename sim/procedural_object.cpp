#include "sim/procedural_object.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "sim/cube_sphere.h"
#include "sim/gradient_noise.h"
#include "sim/seeded_random.h"

namespace lumitexel {
namespace {

// Radius and height of the outline from the bottom's centre to the lid's, as shares of the size.
const std::vector<Eigen::Vector2d>& outline_knots() {
  static const std::vector<Eigen::Vector2d> knots{{0.0, -0.5},   {0.14, -0.5},  {0.245, -0.488}, {0.26, -0.45},
                                                  {0.25, -0.40}, {0.30, -0.31}, {0.385, -0.18},  {0.42, -0.03},
                                                  {0.40, 0.10},  {0.335, 0.205}, {0.28, 0.275},  {0.265, 0.33},
                                                  {0.275, 0.375}, {0.25, 0.42}, {0.175, 0.458}, {0.085, 0.487},
                                                  {0.0, 0.5}};
  return knots;
}

Eigen::Vector2d catmull_rom(const std::vector<Eigen::Vector2d>& knots, double place) {
  const auto last = static_cast<int>(knots.size()) - 1;
  const int left = std::clamp(static_cast<int>(place), 0, last - 1);
  const double t = place - left;
  const auto knot = [&](int i) -> Eigen::Vector2d {  // mirrored in the axis beyond the ends, so that the poles are smooth
    const Eigen::Vector2d& known = knots[static_cast<std::size_t>(i < 0 ? -i : i > last ? 2 * last - i : i)];
    return i < 0 || i > last ? Eigen::Vector2d(-known.x(), known.y()) : known;
  };
  const Eigen::Vector2d a = knot(left - 1), b = knot(left), c = knot(left + 1), d = knot(left + 2);
  return b + 0.5 * t * (c - a + t * (2.0 * a - 5.0 * b + 4.0 * c - d + t * (3.0 * (b - c) + d - a)));
}

// The outline by its length, so that triangles keep their size along it.
class Outline {
 public:
  Outline() {
    constexpr int kSamples = 2000;
    const double last = static_cast<double>(outline_knots().size() - 1);
    for (int i = 0; i <= kSamples; ++i) points_.push_back(catmull_rom(outline_knots(), last * i / kSamples));
    length_.assign(1, 0.0);
    for (std::size_t i = 1; i < points_.size(); ++i) {
      length_.push_back(length_.back() + (points_[i] - points_[i - 1]).norm());
    }
  }

  Eigen::Vector2d at(double share) const {
    const double wanted = share * length_.back();
    const auto upper = std::upper_bound(length_.begin() + 1, length_.end() - 1, wanted) - length_.begin();
    const auto i = static_cast<std::size_t>(upper);
    const double t = (wanted - length_[i - 1]) / (length_[i] - length_[i - 1]);
    return (1.0 - t) * points_[i - 1] + t * points_[i];
  }

 private:
  std::vector<Eigen::Vector2d> points_;
  std::vector<double> length_;
};

Eigen::Vector3d on_smooth_vase(const Outline& outline, const Eigen::Vector3d& direction) {
  const double polar = std::atan2(direction.head<2>().norm(), -direction.z());  // from the bottom's centre
  const double share = polar / std::numbers::pi, azimuth = std::atan2(direction.y(), direction.x());
  const Eigen::Vector2d point = outline.at(share);
  // Flutes that twist with height and fade towards both centres; a second, wider one spoils the symmetry, so that
  // no turn of the table maps the vase onto itself.
  const double fade = std::pow(std::sin(polar), 3);
  const double swell = 1.0 + fade * (0.035 * std::cos(7.0 * azimuth + 3.0 * point.y()) +
                                     0.040 * std::cos(2.0 * azimuth - 0.7) + 0.02 * std::sin(azimuth));
  const double radius = point.x() * swell;
  return {radius * std::cos(azimuth), radius * std::sin(azimuth), point.y()};
}

Mesh smooth_vase(const VaseOptions& options, int cells) {
  const Outline outline;
  Mesh mesh = cube_sphere(cells);
  for (Eigen::Vector3d& position : mesh.positions) {
    position = options.centre_in_table + options.size_m * on_smooth_vase(outline, position);
  }
  mesh.normals = vertex_normals(mesh);
  return mesh;
}

// Hammer marks some 10 mm apart and a finer grain, at 16 cm.
double relief(const Eigen::Vector3d& x_in_table, const VaseOptions& options) {
  const Eigen::Vector3d x = x_in_table / options.size_m;
  return gradient_noise(14.0 * x, extended_key(options.seed, std::uint64_t(300))) +
         0.55 * gradient_noise(45.0 * x, extended_key(options.seed, std::uint64_t(301)));
}

}  // namespace

Mesh vase(const VaseOptions& options) {
  constexpr int kCells = 158;
  Mesh mesh = smooth_vase(options, kCells);
  std::vector<double> height;
  for (const Eigen::Vector3d& position : mesh.positions) height.push_back(relief(position, options));
  const double square_sum = std::inner_product(height.begin(), height.end(), height.begin(), 0.0);
  const double scale = options.relief_rms_m / std::sqrt(square_sum / static_cast<double>(height.size()));
  for (std::size_t i = 0; i < height.size(); ++i) mesh.positions[i] += scale * height[i] * mesh.normals[i];
  mesh.normals = vertex_normals(mesh);
  return mesh;
}

Mesh vase_scan(const VaseOptions& options) {
  constexpr int kCells = 48;
  return smooth_vase(options, kCells);
}

}  // namespace lumitexel
