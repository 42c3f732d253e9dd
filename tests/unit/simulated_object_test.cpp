#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "processing/surface/mesh_file.h"
#include "processing/surface/ray_scene.h"
#include "sim/cube_sphere.h"
#include "sim/gradient_noise.h"
#include "sim/loaded_object.h"
#include "sim/procedural_object.h"
#include "sim/surface_pattern.h"
#include "temporary_folder.h"

namespace lumitexel {
namespace {

// V - E + F, or -1 if some edge does not have exactly one triangle on each side.
int euler_characteristic(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;  // directed
  for (const auto& t : mesh.triangles) {
    for (std::size_t k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  }
  for (const auto& [edge, count] : edges) {
    if (count != 1 || edges.count({edge.second, edge.first}) != 1) return -1;
  }
  return static_cast<int>(mesh.positions.size()) - static_cast<int>(edges.size() / 2) +
         static_cast<int>(mesh.triangles.size());
}

double volume(const Mesh& mesh) {
  double sum = 0.0;
  for (const auto& [a, b, c] : mesh.triangles) {
    sum += mesh.positions[a].dot(mesh.positions[b].cross(mesh.positions[c])) / 6.0;
  }
  return sum;
}

struct Deviation {
  double rms_m = 0, normals_rms_deg = 0;
};

// Of the true surface's vertices and normals from the scan, along the true normal.
Deviation deviation(const Mesh& truth, const Mesh& scan) {
  constexpr double kReach_m = 0.002;
  const RayScene rays(scan);
  double square_sum = 0.0, angle_sum = 0.0;
  int count = 0;
  for (std::size_t i = 0; i < truth.positions.size(); i += 17) {
    const Eigen::Vector3d& normal = truth.normals[i];
    const auto hit = rays.closest(truth.positions[i] + kReach_m * normal, -normal);
    if (!hit || hit->distance_m > 2.0 * kReach_m) continue;
    const auto& [a, b, c] = scan.triangles[hit->triangle];
    const Eigen::Vector3d scanned = ((1.0 - hit->u - hit->v) * scan.normals[a] + hit->u * scan.normals[b] +
                                     hit->v * scan.normals[c]).normalized();
    square_sum += std::pow(hit->distance_m - kReach_m, 2);
    angle_sum += std::pow(std::acos(std::min(1.0, scanned.dot(normal))), 2);
    ++count;
  }
  return {std::sqrt(square_sum / count), std::sqrt(angle_sum / count) * 180.0 / std::numbers::pi};
}

TEST(CubeSphere, IsClosedOutwardAndNearlyTheUnitSphere) {
  const Mesh mesh = cube_sphere(20);
  EXPECT_EQ(mesh.triangles.size(), 12u * 20 * 20);
  EXPECT_EQ(euler_characteristic(mesh), 2);
  // A chord of 90/20 degrees takes about (theta^2 / 8) * 3 off the volume: 0.25 %.
  EXPECT_NEAR(volume(mesh), 4.0 / 3.0 * std::numbers::pi, 0.003 * 4.2);
}

TEST(Vase, IsOneClosedSurfaceOfTheWantedSize) {
  const VaseOptions options;
  const Mesh truth = vase(options), scan = vase_scan(options);
  EXPECT_EQ(euler_characteristic(truth), 2);
  EXPECT_EQ(euler_characteristic(scan), 2);
  EXPECT_GT(volume(truth), 0.0);
  EXPECT_NEAR(static_cast<double>(truth.triangles.size()), 300e3, 1e3);
  double low = 1.0, high = -1.0;
  for (const Eigen::Vector3d& x : truth.positions) low = std::min(low, x.z()), high = std::max(high, x.z());
  EXPECT_NEAR(high - low, options.size_m, 0.001);  // the relief adds its own tenths of a millimetre
}

TEST(Vase, ItsScanIsOffByTheWantedDistanceAndMissesTheRelief) {
  const VaseOptions options;
  const Deviation off = deviation(vase(options), vase_scan(options));
  EXPECT_NEAR(off.rms_m, 1.0e-4, 0.15e-4);  // the coarse triangles' chords add to the relief's rms
  EXPECT_GT(off.normals_rms_deg, 2.0);
  EXPECT_LT(off.normals_rms_deg, 6.0);
}

TEST(LoadedObject, IsTurnedScaledAndCentred) {
  const TemporaryFolder folder;
  Mesh box = cube_sphere(6);
  for (Eigen::Vector3d& x : box.positions) x = Eigen::Vector3d(1.0 * x.x(), 5.0 * x.y(), 2.0 * x.z()) + Eigen::Vector3d(3, 3, 3);
  box.normals = vertex_normals(box);
  write_ply(folder / "box.ply", box);
  const Mesh loaded = loaded_object(folder / "box.ply", true, 0.1, {0.0, 0.0, 0.02});
  Eigen::Vector3d low = Eigen::Vector3d::Ones(), high = -low;
  for (const Eigen::Vector3d& x : loaded.positions) low = low.cwiseMin(x), high = high.cwiseMax(x);
  EXPECT_NEAR((0.5 * (low + high) - Eigen::Vector3d(0, 0, 0.02)).norm(), 0.0, 1e-12);
  EXPECT_NEAR(high.z() - low.z(), 0.1, 1e-12);   // the file's y
  EXPECT_NEAR(high.x() - low.x(), 0.04, 1e-12);  // the file's z
  EXPECT_GT(volume(loaded), 0.0);                // turned, not mirrored
}

TEST(LoadedObject, SmoothingStopsAtTheWantedDeviation) {
  VaseOptions options;
  const Mesh truth = vase(options);
  const Mesh scan = smoothed(truth, 5e-5);
  double square_sum = 0.0;
  for (std::size_t i = 0; i < truth.positions.size(); ++i) {
    square_sum += std::pow((scan.positions[i] - truth.positions[i]).dot(truth.normals[i]), 2);
  }
  const double rms = std::sqrt(square_sum / static_cast<double>(truth.positions.size()));
  EXPECT_GE(rms, 5e-5);
  EXPECT_LT(rms, 6e-5);  // one round more than needed moves little
}

TEST(GradientNoise, IsContinuousAcrossTheLatticeAndOfTheStatedSize) {
  constexpr double kStep = 1e-7;  // slopes are of order 1
  double sum = 0.0, square_sum = 0.0;
  constexpr int kPoints = 20000;
  for (int i = 0; i < kPoints; ++i) {
    const Eigen::Vector3d at(0.37 * i, 0.11 * i, std::floor(0.23 * i));
    const double here = gradient_noise(at + Eigen::Vector3d(0, 0, kStep), 5);
    ASSERT_NEAR(here, gradient_noise(at - Eigen::Vector3d(0, 0, kStep), 5), 1e-5);
    const double value = gradient_noise(at + Eigen::Vector3d(0, 0, 0.61), 5);
    sum += value;
    square_sum += value * value;
  }
  EXPECT_NEAR(sum / kPoints, 0.0, 0.01);
  EXPECT_NEAR(std::sqrt(square_sum / kPoints), 0.25, 0.05);
}

TEST(SurfacePattern, BlendsFourMaterialsWithSharpBorders) {
  const Mesh surface = vase_scan({});
  const SurfacePattern pattern{.seed = 1, .materials = 4, .size_m = 0.16};
  std::array<int, 4> area{};
  int blended = 0;
  for (const Eigen::Vector3d& x : surface.positions) {
    const PatternPoint point = pattern.at(x);
    double sum = 0.0;
    for (const double weight : point.weight) sum += weight;
    ASSERT_NEAR(sum, 1.0, 1e-12);
    const int dominant = point.dominant();
    ++area[static_cast<std::size_t>(dominant)];
    if (point.weight[static_cast<std::size_t>(dominant)] < 0.95) ++blended;
  }
  const int all = static_cast<int>(surface.positions.size());
  for (const int part : area) EXPECT_GT(part, all / 10);
  EXPECT_LT(blended, all / 5);
  EXPECT_GT(blended, 0);
}

}  // namespace
}  // namespace lumitexel
