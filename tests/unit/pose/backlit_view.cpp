#include "tests/unit/pose/backlit_view.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "processing/calibration/pose/centred_pose.h"

namespace lumitexel {
namespace {

constexpr int kBlock = 8;

class Darkness {
 public:
  explicit Darkness(const BacklitScene& scene) : scene_(scene), mesh_from_camera_(scene.camera_from_mesh.inverse()) {}
  bool at(double x, double y) const {
    const Eigen::Vector2d pixel(x, y);
    for (const DarkDisc& disc : scene_.discs) {
      if ((pixel - disc.centre_px).squaredNorm() < disc.radius_px * disc.radius_px) return true;
    }
    const Eigen::Vector3d direction = mesh_from_camera_.linear() * scene_.camera.unproject(pixel);
    return scene_.rays.occluded(mesh_from_camera_.translation(), direction, 0.0, 100.0);
  }
  double share_of_pixel(int x, int y) const {
    const int n = scene_.subsamples;
    int dark = 0;
    for (int k = 0; k < n * n; ++k) dark += at(x + (k % n + 0.5) / n, y + (k / n + 0.5) / n);
    return static_cast<double>(dark) / (n * n);
  }

 private:
  const BacklitScene& scene_;
  Eigen::Isometry3d mesh_from_camera_;
};

}  // namespace

MosaicRadiance backlit_view(const BacklitScene& scene, std::uint64_t seed) {
  MosaicRadiance image;
  image.width = scene.camera.width_px;
  image.height = scene.camera.height_px;
  const std::size_t size = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  image.value.assign(size, 1.0f);
  image.flags.assign(size, 0);
  const Darkness darkness(scene);
  // Corners of blocks first: where a block's neighbourhood is even, so is the block.
  const int columns = image.width / kBlock + 1, rows = image.height / kBlock + 1;
  std::vector<char> corner(static_cast<std::size_t>(columns * rows));
  const auto corner_at = [&](int i, int j) -> char& { return corner[static_cast<std::size_t>(std::clamp(j, 0, rows - 1) * columns + std::clamp(i, 0, columns - 1))]; };
  for (int j = 0; j < rows; ++j)
    for (int i = 0; i < columns; ++i) corner_at(i, j) = darkness.at(i * kBlock + 0.01, j * kBlock + 0.01);
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      int dark = 0;
      for (int dj = -1; dj <= 2; ++dj)
        for (int di = -1; di <= 2; ++di) dark += corner_at(i + di, j + dj);
      if (dark == 0) continue;
      for (int y = j * kBlock; y < std::min(image.height, (j + 1) * kBlock); ++y) {
        for (int x = i * kBlock; x < std::min(image.width, (i + 1) * kBlock); ++x) {
          double share = 1.0;
          if (dark < 16) {
            const int probes = darkness.at(x, y) + darkness.at(x + 1, y) + darkness.at(x, y + 1) + darkness.at(x + 1, y + 1);
            share = probes == 0 ? 0.0 : probes == 4 ? 1.0 : darkness.share_of_pixel(x, y);
          }
          image.value[image.index(x, y)] = static_cast<float>(1.0 - share);
        }
      }
    }
  }
  const double panel = scene.panel_e > 0.0 ? scene.panel_e : 1e6;
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  image.variance.resize(size);
  for (std::size_t i = 0; i < size; ++i) {
    const double electrons = panel * image.value[i];
    const double variance = electrons + scene.read_noise_e * scene.read_noise_e;
    image.variance[i] = static_cast<float>(variance / (panel * panel));
    if (scene.panel_e > 0.0) image.value[i] = static_cast<float>((electrons + std::sqrt(variance) * normal(random)) / panel);
  }
  return image;
}

CameraModel bench_camera(double scale) {
  return {static_cast<int>(std::lround(4096 * scale)), static_cast<int>(std::lround(3072 * scale)), 11800 * scale, 11800 * scale,
          2065.2 * scale, 1519.2 * scale, -0.08, 0.15, 0.0004, -0.0003};
}

Eigen::Isometry3d bench_camera_from_table() {
  const Eigen::Vector3d eye(0.8660254037844387, 0.0, 0.5);
  Eigen::Matrix3d axes;  // rows: right, down, forward
  const Eigen::Vector3d forward = -eye.normalized(), right = forward.cross(Eigen::Vector3d::UnitZ()).normalized();
  axes.row(0) = right;
  axes.row(1) = forward.cross(right);
  axes.row(2) = forward;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = axes;
  pose.translation() = -axes * eye;
  return pose;
}

Eigen::Isometry3d disturbed(const Eigen::Isometry3d& camera_from_mesh, const Mesh& mesh, const Eigen::Vector3d& turn_deg,
                            const Eigen::Vector3d& shift_m) {
  PoseStep step;
  step << turn_deg * std::numbers::pi / 180.0, shift_m;
  return CentredPose(camera_from_mesh, extent_of(mesh).centre).moved(step).camera_from_mesh();
}

PoseError pose_error(const Eigen::Isometry3d& estimate, const Eigen::Isometry3d& truth, const Mesh& mesh) {
  const Eigen::Vector3d centre = extent_of(mesh).centre;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(estimate.linear() * truth.linear().transpose()));
  PoseError error;
  const double angle = turn.angle() > std::numbers::pi ? turn.angle() - 2.0 * std::numbers::pi : turn.angle();
  error.step << angle * turn.axis(), estimate * centre - truth * centre;
  error.turn_deg = std::abs(angle) * 180.0 / std::numbers::pi;
  error.shift_m = error.step.tail<3>().norm();
  return error;
}

}  // namespace lumitexel
